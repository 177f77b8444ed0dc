# SPDX-License-Identifier: GPL-3.0-or-later
"""The strands of hair as they are shown in a frame, after the hair's modifiers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from .. import ids
from ..counting import by_count, counted
from ..errors import RefusalError
from ..reading import attributes, cage, transform
from . import proxy
from .followers import live_modifier_of
from .posed_surface import transformed

_SMOOTH_TYPES = (2, 3)  # Blender's numbers of Bezier and NURBS curves


def read(
    ob: bpy.types.Object, space: np.ndarray, depsgraph: bpy.types.Depsgraph
) -> tuple[np.ndarray, np.ndarray]:
    """Reads hair with one strand or more. Returns points (m, 3) in the space that the matrix
    `space` maps to the world, and the first point of each strand, with the number of all points at
    the end. Raises RefusalError where modifiers change the number of strands, and where coordinates
    are not finite numbers.
    """
    with shown_as(ob, depsgraph) as shown:
        points, offsets, matrix = _read(ob, shown)
    if np.array_equal(matrix, space):
        return points, offsets
    return transformed(np.linalg.solve(space, matrix), points), offsets


@contextmanager
def shown_as(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Iterator[bpy.types.Object]:
    """Yields the evaluated object. Blender does not evaluate hair that is disabled in viewports or
    not in the view layer, and hair that reads a proxy may be shown elsewhere, so a copy of it is
    evaluated. Raises RefusalError where that is no use.
    """
    shown = ob.evaluated_get(depsgraph)
    if shown.is_evaluated and not proxy.is_read_by(ob):
        yield shown
        return
    if live_modifier_of(ob):
        raise RefusalError(
            f"{ob.name} follows live, but is disabled in viewports or is not in this view layer, "
            "so it does not move: enable it first"
        )
    with proxy.aside(), cage.evaluated_copy(ob, len(ob.modifiers), depsgraph) as copy:
        yield copy


def warning_of_types(ob: bpy.types.Object) -> str:
    """Returns a warning for hair whose strands are shown as other curves than the lines between
    their points, or nothing. Catmull-Rom strands, which run through their points, count as lines.
    """
    stored = ob.data.attributes.get(ids.CURVE_TYPE)
    if stored is None or (stored.data_type, stored.domain) != ("INT8", "CURVE"):
        return ""
    types = np.empty(len(stored.data), np.int8)
    stored.data.foreach_get("value", types)
    count = int(np.isin(types, _SMOOTH_TYPES).sum())
    if not count:
        return ""
    are = by_count(count, "is a Bezier or NURBS curve", "are Bezier or NURBS curves")
    return (
        f"{counted(count, 'strands')} of {ob.name} {are}. Only their control points were used: "
        "convert them to Poly or Catmull Rom to use the curves that are shown"
    )


def _read(
    ob: bpy.types.Object, shown: bpy.types.Object
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns points, the first point of each strand, and the matrix that maps them to the
    world.
    """
    count = len(ob.data.curves)
    if len(shown.data.curves) != count:
        raise RefusalError(
            f"The modifiers of {ob.name} change its number of strands, from {count:,} to "
            f"{len(shown.data.curves):,}: disable or apply them"
        )
    offsets = attributes.curve_offsets(shown.data)
    points = attributes.read(shown.data, "position").astype(np.float64)
    lost = ~np.isfinite(points).all(axis=1)
    if lost.any():
        strand = int(np.searchsorted(offsets, lost.argmax(), side="right")) - 1
        raise RefusalError(
            f"Strand {strand} of {ob.name} has coordinates that are not finite numbers: delete it"
        )
    matrix = np.array(shown.matrix_world, np.float64)
    transform.check_invertible(matrix, ob.name)
    return points, offsets, matrix
