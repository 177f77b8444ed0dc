# SPDX-License-Identifier: GPL-3.0-or-later
"""A vertex of a mesh in Edit Mode that is dragged."""

from contextlib import suppress

import bmesh
import bpy
import numpy as np
from mathutils import Vector

from ..errors import RefusalError
from ..placing.posed_surface import transformed
from ..snap.mesh_vertices import move_in_object_mode, points_in_object_mode
from ..tasks.object_keys import ObjectKey
from ..tasks.unchanged import AGAIN, Unchanged
from .handles import Place


class DraggedVertex:
    can_turn, has_strand = False, False

    def __init__(self, ob: bpy.types.Object, index: int) -> None:
        self.name = f"vertex {index} of {ob.name}"
        self._key, self._unchanged, self._index = ObjectKey.of(ob), Unchanged(ob), index
        self._kept = self._left = self._position(ob)

    def check(self) -> None:
        self._unchanged.check()
        ob = self._key.find()
        if self._position(ob) != self._left:
            raise RefusalError(f"Points of {ob.name} were moved meanwhile: {AGAIN}")

    def put(self, place: Place, align: str, hair: str) -> None:
        self.check()
        into_object = np.linalg.inv(np.array(self._key.find().matrix_world, np.float64))
        self._set(Vector(transformed(into_object, place.position)))

    def restore(self) -> None:
        with suppress(RefusalError):
            self.check()
            self._set(self._kept)
            return
        ob = self._key.among(bpy.data.objects)
        if ob is not None and not ob.data.is_editmode:
            self._restore_outside(ob)

    def confirm(self, place: Place, align: str) -> None:
        pass

    def _restore_outside(self, ob: bpy.types.Object) -> None:
        """Puts the vertex back where somebody has left Edit Mode, which keeps it where it was."""
        points = points_in_object_mode(ob)
        if self._index < len(points) and tuple(points[self._index]) == tuple(self._left):
            move = np.array([self._kept], np.float64) - np.array([self._left], np.float64)
            move_in_object_mode(ob, np.array([self._index]), move)
            self._left = self._kept

    def _set(self, position: Vector) -> None:
        ob = self._key.find()
        edited = _edited(ob)
        edited.verts[self._index].co = position
        self._left = self._position(ob)
        bmesh.update_edit_mesh(ob.data, loop_triangles=True, destructive=False)

    def _position(self, ob: bpy.types.Object) -> Vector:
        edited = _edited(ob)  # its vertices exist as long as this is referred to
        return edited.verts[self._index].co.copy()


def _edited(ob: bpy.types.Object) -> bmesh.types.BMesh:
    edited = bmesh.from_edit_mesh(ob.data)
    edited.verts.ensure_lookup_table()
    return edited
