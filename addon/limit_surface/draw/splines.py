# SPDX-License-Identifier: GPL-3.0-or-later
"""The splines of Curve objects: fitted curves are written, and strokes are read from them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..placing.posed_surface import transformed
from ..placing.roots import Locations
from ..reading import splines
from .fitting import Spline
from .ground import Ground
from .stroke import Stroke

_ALIGNED, _FREE = "ALIGNED", "FREE"
#: The sine of the angle up to which two handles count as aligned
_STRAIGHT = 1e-3


def add(data: bpy.types.Curve, made: Sequence[Spline]) -> None:
    for spline in made:
        _fill(data.splines.new("POLY" if spline.handles is None else "BEZIER"), spline)
    data.update_tag()


def _fill(new: bpy.types.Spline, spline: Spline) -> None:
    count = len(spline.position)
    if spline.handles is None:
        new.points.add(count - 1)
        new.points.foreach_set("co", np.insert(spline.position, 3, 1, axis=1).ravel())
        new.points.foreach_set("radius", spline.radius.astype(np.float32))
    else:
        points = new.bezier_points
        points.add(count - 1)
        left, right = spline.handles
        types = _handle_types(spline)
        # Blender moves aligned handles when it is told a handle's type: the types come first.
        for name in ("handle_left_type", "handle_right_type"):
            points.foreach_set(name, types)
        points.foreach_set("co", spline.position.ravel())
        points.foreach_set("handle_left", left.ravel())
        points.foreach_set("handle_right", right.ravel())
        points.foreach_set("radius", spline.radius.astype(np.float32))
        new.resolution_u = spline.resolution
    new.use_cyclic_u = spline.is_closed
    new.use_smooth, new.material_index = spline.use_smooth, spline.material_index


def _handle_types(spline: Spline) -> np.ndarray:
    """Returns the number of the type of each point's handles: free at corners, else aligned."""
    left, right = (each.astype(np.float64) - spline.position for each in spline.handles or ())
    sine = np.linalg.norm(np.cross(left, right), axis=1)
    lengths = np.linalg.norm(left, axis=1) * np.linalg.norm(right, axis=1)
    aligned = (sine <= _STRAIGHT * lengths) & (np.einsum("ij,ij->i", left, right) < 0)
    items = bpy.types.BezierSplinePoint.bl_rna.properties["handle_left_type"].enum_items
    return np.where(aligned, items[_ALIGNED].value, items[_FREE].value).astype(np.int32)


def remove(data: bpy.types.Curve, numbers: Sequence[int]) -> None:
    for spline in [data.splines[number] for number in sorted(set(numbers), reverse=True)]:
        data.splines.remove(spline)


def locations(data: bpy.types.Curve) -> Locations | None:
    """Returns the stored locations of all control points, if there is one for each."""
    face, uv = data.get(ids.FACE), data.get(ids.UV)
    count = sum(len(splines.points(spline)) for spline in data.splines)
    if face is None or uv is None or len(face) != count or len(uv) != 2 * count:
        return None
    return Locations(np.array(face, np.int32), np.array(uv, np.float32).reshape(-1, 2))


def store_locations(data: bpy.types.Curve, found: Locations) -> None:
    data[ids.FACE] = found.face.tolist()
    data[ids.UV] = found.uv.ravel().tolist()


def joined(parts: Sequence[Locations]) -> Locations:
    return Locations(
        np.concatenate([np.empty(0, np.int32), *(part.face for part in parts)]),
        np.concatenate([np.empty((0, 2), np.float32), *(part.uv for part in parts)]),
    )


def strokes(ob: bpy.types.Object, ground: Ground, tolerance: float) -> list[Stroke]:
    """Returns the strokes of a Curve object, laid onto the surface, each with the number of its
    spline. A spline of one point has none; one that cannot be laid in one piece has several.
    """
    return [each for laid in strokes_by_spline(ob, ground, tolerance) for each in laid]


def strokes_by_spline(
    ob: bpy.types.Object, ground: Ground, tolerance: float
) -> Iterator[list[Stroke]]:
    """Yields the strokes of one spline after the other. No spline is held meanwhile: undo may
    replace it.
    """
    for number in range(len(ob.data.splines)):
        spline = ob.data.splines[number]
        if spline.type == "NURBS":
            raise RefusalError(
                f"{ob.name} has NURBS splines: convert them to Bézier or poly splines first"
            )
        points = splines.points(spline)
        if len(points) < 2:
            continue
        laid = ground.lay(
            *_curve(spline, np.array(ob.matrix_world, np.float64)),
            tolerance,
            spline.use_cyclic_u,
            _handles(spline, np.array(ob.matrix_world, np.float64)),
        )
        yield [replace(piece, spline=number) for piece in laid]


def _curve(spline: bpy.types.Spline, matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    points = splines.points(spline)
    radius = np.empty(len(points), np.float32)
    points.foreach_get("radius", radius)
    position = splines.values(points, "co")[:, :3].astype(np.float64)
    return transformed(matrix, position), radius.astype(np.float64)


def _handles(spline: bpy.types.Spline, matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    if spline.type != "BEZIER":
        return None
    left, right = (
        transformed(matrix, splines.values(spline.bezier_points, name).astype(np.float64))
        for name in ("handle_left", "handle_right")
    )
    return left, right
