# SPDX-License-Identifier: GPL-3.0-or-later
"""The strands of hair as they are shown in a frame, after the hair's modifiers."""

from __future__ import annotations

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import attributes, transform
from .posed_surface import transformed


def read(
    ob: bpy.types.Object, space: np.ndarray, depsgraph: bpy.types.Depsgraph
) -> tuple[np.ndarray, np.ndarray]:
    """Reads hair with one strand or more. Returns points (m, 3) in the space that the matrix
    `space` maps to the world, and the first point of each strand, with the number of all points at
    the end. Raises RefusalError where modifiers change the number of strands, and where coordinates
    are not finite numbers.
    """
    shown, count = ob.evaluated_get(depsgraph), len(ob.data.curves)
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
    matrix = transform.world_matrix(shown)
    if np.array_equal(matrix, space):
        return points, offsets
    return transformed(np.linalg.solve(space, matrix), points), offsets
