# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole objects: their origins are put on the surface, and their Z along its normal."""

import bpy
import numpy as np
from mathutils import Matrix

from ..counting import by_count, counted
from ..placing.rotations import unit
from .aim import Elements, Placement
from .choices import Choices, Outcome
from .object_move import ELSEWHERE, ObjectMove

# in this case the child follows the parent's own matrix
_NOTHING_BETWEEN = ("OBJECT", "ARMATURE", "LATTICE")


class SnappedObjects:
    noun = "objects"
    stores_location = False
    follower = None

    def __init__(self, objects: list[bpy.types.Object]) -> None:
        self._objects = objects

    def elements(self) -> Elements:
        matrix = np.array([ob.matrix_world for ob in self._objects], np.float64)
        axes = np.swapaxes(unit(np.swapaxes(matrix[:, :3, :3], 1, 2)), 1, 2)
        return Elements(matrix[:, :3, 3], lambda: axes[:, :, 2], axes)

    def place(self, placement: Placement, choices: Choices) -> Outcome:
        """Places parents before their children, whose transforms depend on the parents' new
        places.
        """
        objects = [self._objects[row] for row in placement.rows]
        children = _children() if choices.keep_children else {}
        depths = np.array([_depth(ob) for ob in objects], int)
        origins = np.array([ob.matrix_world.translation for ob in objects], np.float64)
        distances = np.linalg.norm(placement.position - origins.reshape(-1, 3), axis=1)
        outcome = Outcome(self.noun)
        unkept = 0
        for depth in np.unique(depths):
            moves: dict[int, ObjectMove] = {}
            kept_by: dict[int, list[_KeptChild]] = {}
            for i in np.flatnonzero(depths == depth):
                moves[i] = ObjectMove(
                    objects[i], placement.position[i], placement.frame[i], choices.align
                )
                kept_by[i] = [_KeptChild(child) for child in children.get(objects[i], ())]
            for move in moves.values():
                move.begin()
            bpy.context.view_layer.update()
            for i, move in moves.items():
                reason = move.finish()
                if reason:
                    outcome.failures[reason] += 1
                    continue
                outcome.distances.append(distances[i : i + 1])
                for child in kept_by[i]:
                    child.hold()
            bpy.context.view_layer.update()
            unkept += sum(not child.is_in_place() for kept in kept_by.values() for child in kept)
        if unkept:
            outcome.notes.append(
                f"{counted(unkept, 'children')} of snapped objects could not be kept where "
                f"{by_count(unkept, 'it was', 'they were')}"
            )
        return outcome


class _KeptChild:
    """A child that is kept in place by its parent inverse, because its own transform may be locked
    or animated.
    """

    def __init__(self, ob: bpy.types.Object) -> None:
        self._ob = ob
        self._before = _array(ob.matrix_world)
        self._parent = _array(ob.parent.matrix_world)

    def hold(self) -> None:
        """Restores the child's place, once Blender has moved the child with its parent."""
        ob = self._ob
        inverse = _array(ob.matrix_parent_inverse)
        if ob.parent_type in _NOTHING_BETWEEN:
            was, now = self._parent, _array(ob.parent.matrix_world)
        else:
            own = np.linalg.pinv(inverse @ _array(ob.matrix_basis))
            was, now = self._before @ own, _array(ob.matrix_world) @ own
        ob.matrix_parent_inverse = Matrix(np.linalg.pinv(now) @ was @ inverse)

    def is_in_place(self) -> bool:
        now = _array(self._ob.matrix_world)
        return np.abs(now - self._before).max() <= ELSEWHERE * np.abs(self._before).max()


def _array(matrix: Matrix) -> np.ndarray:
    return np.array(matrix, np.float64)


def _depth(ob: bpy.types.Object) -> int:
    return 1 + _depth(ob.parent) if ob.parent else 0


def _children() -> dict[bpy.types.Object, list[bpy.types.Object]]:
    found: dict[bpy.types.Object, list[bpy.types.Object]] = {}
    for ob in bpy.data.objects:
        if ob.parent:
            found.setdefault(ob.parent, []).append(ob)
    return found
