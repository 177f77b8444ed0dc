# SPDX-License-Identifier: GPL-3.0-or-later
"""A strand of hair that is dragged by its root."""

from contextlib import suppress

import bpy
import numpy as np

from .. import ids, native
from ..errors import RefusalError
from ..placing.posed_surface import Places, transformed
from ..placing.present_shape import PresentShape
from ..placing.rotations import WorldSpace
from ..snap.binding_again import will_follow
from ..snap.hair_binding import HairBinding
from ..snap.strands import Strands
from ..snap.surface import TargetSurface
from ..tasks.object_keys import ObjectKey
from ..tasks.unchanged import AGAIN, Unchanged
from .handles import Place

_CURVE_POINTS = (ids.POSITION, "handle_left", "handle_right")


class DraggedStrand:
    can_turn, has_strand = True, True

    def __init__(self, ob: bpy.types.Object, curve: int, surface: TargetSurface) -> None:
        self.name = f"strand {curve} of {ob.name}"
        self._key, self._unchanged = ObjectKey.of(ob), Unchanged(ob)
        self._curve = np.array([curve])
        self._shape = PresentShape(ob, bpy.context.evaluated_depsgraph_get())
        self._is_whole = len(ob.data.curves) == 1
        self._is_bound, self._rest = self._binding(surface).rest_frames(self._curve)
        info, stored = ob.data.curves[curve], ob.data.attributes
        self._rows = range(info.first_point_index, info.first_point_index + info.points_length)
        names = [name for name in _CURVE_POINTS if name in stored]
        self._kept = {name: self._read(ob.data, name) for name in names}
        self._left = dict(self._kept)
        self._shown = {name: self._shape.read(name)[self._rows] for name in names}
        self._tile = stored[ids.TILE].data[curve].value if ids.TILE in stored else None

    def check(self) -> None:
        self._unchanged.check()
        ob = self._key.find()
        for name in (*self._kept, *([ids.TILE] if self._tile is not None else [])):
            if name not in ob.data.attributes:
                raise RefusalError(
                    f"The attribute {name} of {ob.name} was changed meanwhile: {AGAIN}"
                )
        for name, left in self._left.items():
            if not np.array_equal(self._read(ob.data, name), left):
                raise RefusalError(f"Points of {ob.name} were moved meanwhile: {AGAIN}")

    def put(self, place: Place, align: str, hair: str) -> None:
        self.check()
        ob = self._key.find()
        matrix = np.array(ob.matrix_world, np.float64)  # its parent may move
        space = WorldSpace(matrix)
        points = transformed(matrix, self._shown[ids.POSITION].astype(np.float64))
        strand = Strands(points, np.array([len(points)]))
        bound = place.surface.places(np.array([place.face]), place.uv[None], matrix)
        turn = self._turn(strand, place, align, space, bound)
        root, weights = place.position[None], strand.weights(hair)
        self._follow(ob.data, 0)  # nodes would move it from where it is dragged to
        for name, shown in self._shown.items():
            points = transformed(matrix, shown.astype(np.float64))
            values = shown + space.to_local(strand.moves(points, root, turn, weights))
            if name == ids.POSITION:
                # where the stored location says, to the last bit, plus the offset
                to = bound.position
                values[0] = (to + space.to_local(place.position - transformed(matrix, to)))[0]
            self._write(ob.data, name, values)

    def restore(self) -> None:
        with suppress(RefusalError):
            self.check()
            data = self._key.find().data
            self._follow(data, self._tile)
            for name, kept in self._kept.items():
                self._write(data, name, kept)

    def confirm(self, place: Place, align: str) -> None:
        ob = self._key.find()
        binding = self._binding(place.surface)
        follows = will_follow(ob, binding.target, "NONE")
        matrix = np.array(ob.matrix_world, np.float64)
        binding.write(self._curve, np.array([place.face]), place.uv[None], matrix, follows)
        ob.data.update_tag()

    def _binding(self, surface: TargetSurface) -> HairBinding:
        return HairBinding(self._shape, surface, self._is_whole)

    def _turn(
        self, strand: Strands, place: Place, align: str, space: WorldSpace, bound: Places
    ) -> np.ndarray:
        """Returns the rotation (1, 3, 3) in world space."""
        if align == "NONE":
            return np.eye(3)[None]
        if align == "NORMAL_DU" and self._is_bound.all():
            return space.frames(bound.frame) @ np.swapaxes(space.frames(self._rest), 1, 2)
        return native.limitsurf.shortest_turns(strand.directions(), place.frame[None, :, 2])

    def _follow(self, data: bpy.types.Curves, tile: int | None) -> None:
        """Has nodes move the strand by this tile; by none if it is 0."""
        if self._tile is not None:
            data.attributes[ids.TILE].data[self._curve[0]].value = tile

    def _read(self, data: bpy.types.Curves, name: str) -> np.ndarray:
        stored = data.attributes[name].data
        return np.array([stored[i].vector for i in self._rows])

    def _write(self, data: bpy.types.Curves, name: str, values: np.ndarray) -> None:
        stored = data.attributes[name].data
        for i, value in zip(self._rows, values, strict=True):
            stored[i].vector = value
        self._left[name] = self._read(data, name)
        data.update_tag()
