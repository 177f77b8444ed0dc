# SPDX-License-Identifier: GPL-3.0-or-later
"""Handles move the one thing that is dragged: again and again, until it is restored or
confirmed.

Between two moves of the mouse other windows and scripts may change or remove it, and undo may take
all of Blender's data away. So handles keep no references, but find the thing anew each time. What
somebody else has changed since the last move is not theirs any more, and is left as it is.
"""

from dataclasses import dataclass
from typing import Protocol

import bpy
import numpy as np

from ..errors import RefusalError
from ..snap.object_move import ObjectMove
from ..snap.surface import TargetSurface
from ..tasks.object_keys import ObjectKey
from ..tasks.unchanged import AGAIN

_TRANSFORM = ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle")


@dataclass(frozen=True)
class Place:
    surface: TargetSurface
    face: int
    uv: np.ndarray  # (2,) representable in single precision
    position: np.ndarray  # (3,) world, offset included
    frame: np.ndarray  # (3, 3) world: columns tangent, normal x tangent, outward normal


class Handle(Protocol):
    name: str
    can_turn: bool
    has_strand: bool

    def check(self) -> None:
        """Raises RefusalError if the thing is not as it was left: removed, changed or moved."""

    def put(self, place: Place, align: str, hair: str) -> None:
        """Raises RefusalError as `check` does."""

    def restore(self) -> None:
        """Puts back what is still as it was left."""

    def confirm(self, place: Place, align: str) -> None:
        """Is called after `put` at the same place. Raises RefusalError if the thing cannot stay
        there.
        """


class DraggedObject:
    can_turn, has_strand = True, False

    def __init__(self, ob: bpy.types.Object) -> None:
        self.name = ob.name
        self._key = ObjectKey.of(ob)
        self._kept = _transform(ob)
        self._put: dict[str, tuple[float, ...]] = {}  # what the last move has changed

    def check(self) -> None:
        now = _transform(self._key.find())
        if any(now[name] != value for name, value in self._put.items()):
            raise RefusalError(f"{self.name} was moved meanwhile: {AGAIN}")

    def put(self, place: Place, align: str, hair: str) -> None:
        self.check()
        self._move(place, align)

    def restore(self) -> None:
        ob = self._key.among(bpy.data.objects)
        if ob is None:
            return
        now = _transform(ob)
        for name, value in self._put.items():
            if now[name] == value:
                setattr(ob, name, self._kept[name])
        self._put = {}

    def confirm(self, place: Place, align: str) -> None:
        reason = self._move(place, align).finish()
        if reason:
            raise RefusalError(f"{self.name} cannot be put there: {reason}")

    def _move(self, place: Place, align: str) -> ObjectMove:
        """Moves the thing from where it was at the beginning, so that intermediate places have no
        effect.
        """
        self.restore()
        bpy.context.view_layer.update()
        ob = self._key.find()
        move = ObjectMove(ob, place.position, place.frame, align)
        try:
            move.begin()
            bpy.context.view_layer.update()  # drivers may hold it
        finally:
            now = _transform(ob)
            self._put = {name: value for name, value in now.items() if value != self._kept[name]}
        return move


def _transform(ob: bpy.types.Object) -> dict[str, tuple[float, ...]]:
    return {name: tuple(getattr(ob, name)) for name in _TRANSFORM}
