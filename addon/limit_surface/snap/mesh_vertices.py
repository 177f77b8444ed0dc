# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices of meshes in Edit Mode.

Arrays can be written to a mesh only outside Edit Mode, so that mode is left for a moment. The shape
keys change as they do when Blender itself leaves that mode.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from .. import ids
from ..reading import attributes
from ..reading.edited_mesh import as_edited
from .element_points import SnappedPoints

_SELECTED, _HIDDEN = ".select_vert", ".hide_vert"


class SnappedVertices(SnappedPoints):
    noun = "vertices"

    def read(self) -> tuple[np.ndarray, np.ndarray]:
        with as_edited(self.ob.data) as mesh:
            points = attributes.read(mesh, ids.POSITION)
            selected, hidden = (_flags(mesh, name) for name in (_SELECTED, _HIDDEN))
        return points, selected & ~hidden

    def normals(self, rows: np.ndarray) -> np.ndarray:
        with as_edited(self.ob.data) as mesh:
            normals = np.empty((len(mesh.vertices), 3), np.float32)
            mesh.vertex_normals.foreach_get("vector", normals.ravel())
        return self.normals_in_world(normals[rows].astype(np.float64))

    def move(self, rows: np.ndarray, moves: np.ndarray) -> None:
        with _outside_edit_mode():
            move_in_object_mode(self.ob, rows, moves)


def points_in_object_mode(ob: bpy.types.Object) -> np.ndarray:
    """Returns the positions (n, 3) of the points that editing the mesh would show."""
    points = ob.active_shape_key.data if ob.active_shape_key else ob.data.vertices
    found = np.empty((len(points), 3), np.float32)
    points.foreach_get("co", found.ravel())
    return found


def move_in_object_mode(ob: bpy.types.Object, rows: np.ndarray, moves: np.ndarray) -> None:
    mesh, key = ob.data, ob.active_shape_key
    if key is None:
        _move_vertices(mesh, rows, moves)
    else:
        blocks = mesh.shape_keys.key_blocks
        for block in (key, *_dependent(key, blocks)):
            _move_points(block.data, rows, moves)
        if key == mesh.shape_keys.reference_key:
            _move_vertices(mesh, rows, moves)
    mesh.update()


def _flags(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """Returns a flag of each vertex. Blender stores no attribute where all are off."""
    if name in mesh.attributes:
        return attributes.read(mesh, name)
    return np.zeros(len(mesh.vertices), bool)


def _move_vertices(mesh: bpy.types.Mesh, rows: np.ndarray, moves: np.ndarray) -> None:
    points = attributes.read(mesh, ids.POSITION)
    points[rows] = points[rows].astype(np.float64) + moves
    attributes.write(mesh, ids.POSITION, "FLOAT_VECTOR", "POINT", points)


def _move_points(
    points: bpy.types.bpy_prop_collection, rows: np.ndarray, moves: np.ndarray
) -> None:
    values = np.empty((len(points), 3), np.float32)
    points.foreach_get("co", values.ravel())
    values[rows] = values[rows].astype(np.float64) + moves
    points.foreach_set("co", values.ravel())


def _dependent(
    key: bpy.types.ShapeKey, blocks: bpy.types.bpy_prop_collection
) -> list[bpy.types.ShapeKey]:
    """Returns the keys that are relative to this one, directly or by way of others: they move with
    it.
    """
    found: list[bpy.types.ShapeKey] = []
    pending = [key]
    while pending:
        basis = pending.pop()
        relative = [
            block
            for block in blocks
            if block.relative_key == basis and block != key and block not in found
        ]
        found += relative
        pending += relative
    return found


@contextmanager
def _outside_edit_mode() -> Iterator[None]:
    context = bpy.context
    edited = list(context.objects_in_mode)
    selected = {ob: ob.select_get() for ob in context.view_layer.objects}
    bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        for ob in selected:
            ob.select_set(ob in edited)
        bpy.ops.object.mode_set(mode="EDIT")
        for ob, was_selected in selected.items():
            ob.select_set(was_selected)
