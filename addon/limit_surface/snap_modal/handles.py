# SPDX-License-Identifier: GPL-3.0-or-later
"""Handles move the one thing that is dragged: again and again, until it is restored or
confirmed.
"""

from dataclasses import dataclass
from typing import Protocol

import bmesh
import bpy
import numpy as np

from .. import ids, native
from ..errors import RefusalError
from ..placing.posed_surface import Places, transformed
from ..placing.present_shape import PresentShape
from ..placing.rotations import WorldSpace
from ..snap.binding_again import will_follow
from ..snap.hair_binding import HairBinding
from ..snap.object_move import ObjectMove
from ..snap.strands import Strands
from ..snap.surface import TargetSurface

_TRANSFORM = ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle")
_CURVE_POINTS = (ids.POSITION, "handle_left", "handle_right")


@dataclass(frozen=True)
class Place:
    face: int
    uv: np.ndarray  # (2,) representable in single precision
    position: np.ndarray  # (3,) world, offset included
    frame: np.ndarray  # (3, 3) world: columns tangent, normal x tangent, outward normal


class Handle(Protocol):
    name: str
    can_turn: bool
    has_strand: bool

    def put(self, place: Place, align: str, hair: str) -> None: ...
    def restore(self) -> None: ...
    def confirm(self, place: Place) -> None:
        """Raises RefusalError if the thing cannot stay there."""


class DraggedObject:
    can_turn, has_strand = True, False

    def __init__(self, ob: bpy.types.Object) -> None:
        self.name = ob.name
        self._ob = ob
        self._kept = {name: np.array(getattr(ob, name)) for name in _TRANSFORM}
        self._move: ObjectMove | None = None

    def put(self, place: Place, align: str, hair: str) -> None:
        """Moves the thing from where it was at the beginning, so that intermediate places have no
        effect.
        """
        self.restore()
        bpy.context.view_layer.update()
        self._move = ObjectMove(self._ob, place.position, place.frame, align)
        self._move.begin()

    def restore(self) -> None:
        for name, value in self._kept.items():
            setattr(self._ob, name, value)

    def confirm(self, place: Place) -> None:
        bpy.context.view_layer.update()
        assert self._move is not None
        reason = self._move.finish()
        if reason:
            raise RefusalError(f"{self.name} cannot be put there: {reason}")


class DraggedVertex:
    can_turn, has_strand = False, False

    def __init__(self, ob: bpy.types.Object, index: int) -> None:
        self.name = f"vertex {index} of {ob.name}"
        self._mesh = ob.data
        self._into_object = np.linalg.inv(np.array(ob.matrix_world, np.float64))
        self._edited = bmesh.from_edit_mesh(self._mesh)
        self._edited.verts.ensure_lookup_table()
        self._vertex = self._edited.verts[index]
        self._kept = self._vertex.co.copy()

    def put(self, place: Place, align: str, hair: str) -> None:
        self._set(transformed(self._into_object, place.position))

    def restore(self) -> None:
        self._set(self._kept)

    def confirm(self, place: Place) -> None:
        pass

    def _set(self, position: np.ndarray) -> None:
        self._vertex.co = position
        bmesh.update_edit_mesh(self._mesh, loop_triangles=True, destructive=False)


class DraggedStrand:
    can_turn, has_strand = True, True

    def __init__(self, ob: bpy.types.Object, curve: int, surface: TargetSurface) -> None:
        self.name = f"strand {curve} of {ob.name}"
        self._ob, self._data, self._curve = ob, ob.data, np.array([curve])
        self._matrix = np.array(ob.matrix_world, np.float64)
        self._space = WorldSpace(self._matrix)
        shape = PresentShape(ob, bpy.context.evaluated_depsgraph_get())
        self._binding = HairBinding(shape, surface, is_whole=len(ob.data.curves) == 1)
        info, stored = ob.data.curves[curve], ob.data.attributes
        self._rows = range(info.first_point_index, info.first_point_index + info.points_length)
        names = [name for name in _CURVE_POINTS if name in stored]
        self._kept = {
            name: np.array([stored[name].data[i].vector for i in self._rows]) for name in names
        }
        self._shown = {name: shape.read(name)[self._rows] for name in names}
        self._tile = stored[ids.TILE].data[curve].value if ids.TILE in stored else None
        points = transformed(self._matrix, self._shown[ids.POSITION].astype(np.float64))
        self._strand = Strands(points, np.array([len(points)]))

    def put(self, place: Place, align: str, hair: str) -> None:
        root, weights = place.position[None], self._strand.weights(hair)
        turn = self._turn(place, align)
        self._follow(0)  # nodes would move it from where it is dragged to
        for name, shown in self._shown.items():
            points = transformed(self._matrix, shown.astype(np.float64))
            moves = self._strand.moves(points, root, turn, weights)
            values = shown + self._space.to_local(moves)
            if name == ids.POSITION:
                values[0] = self._root(place)
            self._write(name, values)

    def restore(self) -> None:
        self._follow(self._tile)
        for name, kept in self._kept.items():
            self._write(name, kept)

    def confirm(self, place: Place) -> None:
        follows = will_follow(self._ob, self._binding.target, "NONE")
        face, uv = np.array([place.face]), place.uv[None]
        self._binding.write(self._curve, face, uv, self._matrix, follows)
        self._data.update_tag()

    def _follow(self, tile: int | None) -> None:
        """Has nodes move the strand by this tile; by none if it is 0."""
        if self._tile is not None:
            self._data.attributes[ids.TILE].data[self._curve[0]].value = tile

    def _turn(self, place: Place, align: str) -> np.ndarray:
        """Returns the rotation (1, 3, 3) in world space."""
        if align == "NONE":
            return np.eye(3)[None]
        if align == "NORMAL_DU":
            bound, rest = self._binding.rest_frames(self._curve)
            if bound.all():
                new = self._bound_place(place).frame
                return self._space.frames(new) @ np.swapaxes(self._space.frames(rest), 1, 2)
        return native.limitsurf.shortest_turns(self._strand.directions(), place.frame[None, :, 2])

    def _root(self, place: Place) -> np.ndarray:
        """Returns the point where the stored location says, to the last bit, plus the offset."""
        bound = self._bound_place(place).position
        return (bound + self._space.to_local(place.position - transformed(self._matrix, bound)))[0]

    def _bound_place(self, place: Place) -> Places:
        return self._binding.places(np.array([place.face]), place.uv[None], self._matrix)

    def _write(self, name: str, values: np.ndarray) -> None:
        data = self._data.attributes[name].data
        for i, value in zip(self._rows, values, strict=True):
            data[i].vector = value
        self._data.update_tag()
