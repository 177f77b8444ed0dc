# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones in an armature's Edit Mode: their heads are put on the surface.

The tail of a selected bone keeps its offset from the head. Where only the head is selected the tail
stays, and the length changes. A joint of connected bones is the head of the child: it is snapped if
the child is selected, or the joint itself; otherwise it moves with the parent.
"""

from collections import Counter
from collections.abc import Iterable

import bpy
import numpy as np

from .. import native
from ..placing.posed_surface import transformed
from ..placing.rotations import WorldSpace, unit
from .aim import Elements, Placement
from .choices import Choices, Outcome

SHORTEST = 2e-6  # Blender removes bones whose length is at most half of this


class SnappedBones:
    noun = "bones"
    stores_location = False
    follower = None

    def __init__(self, ob: bpy.types.Object) -> None:
        self._matrix = np.array(ob.matrix_world, np.float64)
        self._space = WorldSpace(self._matrix, ob.name)
        chosen = [b for b in _parents_first(ob.data) if _is_shown(b) and _is_head_chosen(b)]
        self._bones = [bone for bone in chosen if not bone.lock]
        self._left_out = Counter({"the bone is locked": len(chosen) - len(self._bones)})
        ends = np.array([(bone.head, bone.tail) for bone in self._bones], np.float64)
        self._heads, self._tails = ends.reshape(-1, 2, 3).swapaxes(0, 1)

    def elements(self) -> Elements:
        heads, tails = (transformed(self._matrix, ends) for ends in (self._heads, self._tails))
        matrices = np.array([bone.matrix.to_3x3() for bone in self._bones], np.float64)
        columns = self._matrix[:3, :3] @ matrices.reshape(-1, 3, 3)
        axes = unit(columns.swapaxes(1, 2)).swapaxes(1, 2)
        return Elements(heads, lambda: unit(tails - heads), axes, self._left_out)

    def place(self, placement: Placement, choices: Choices) -> Outcome:
        elements, rows = self.elements(), placement.rows
        moves = placement.position - elements.points[rows]
        heads = self._heads[rows] + self._space.to_local(moves)
        tails = self._tails[rows] + self._space.to_local(moves)
        align = choices.align != "NONE"
        if align:
            along, up = _aligned(elements.axes[rows], placement.frame, choices.align)
            length = (self._tails[rows] - self._heads[rows]) @ self._matrix[:3, :3].T
            length = np.linalg.norm(length, axis=1, keepdims=True)
            tails = heads + self._space.to_local(length * along)
            up = self._space.to_local(up)

        placed = np.ones(len(rows), bool)
        for i, row in enumerate(rows):
            bone = self._bones[row]
            placed[i] = _put_head(bone, heads[i])
            if placed[i] and bone.select:
                bone.tail = tails[i]
                if align:
                    bone.align_roll(up[i])
        outcome = Outcome(self.noun, [np.linalg.norm(moves[placed], axis=1)])
        outcome.failures["the bone would have no length"] = np.count_nonzero(~placed)
        return outcome


def _put_head(bone: bpy.types.EditBone, head: np.ndarray) -> bool:
    """Puts the head there, unless the bone would become so short that Blender removes it."""
    if bone.use_connect:
        holder, end = bone.parent, "tail"  # this moves the heads of all connected bones, too
        affected = [holder, *(child for child in holder.children if child.use_connect)]
    else:
        holder, end, affected = bone, "head", [bone]
    before = getattr(holder, end).copy()
    setattr(holder, end, head)
    if bone.select:
        affected.remove(bone)  # its tail moves with it
    if all(each.length > SHORTEST for each in affected):
        return True
    setattr(holder, end, before)
    return False


def _aligned(axes: np.ndarray, frame: np.ndarray, align: str) -> tuple[np.ndarray, np.ndarray]:
    """Returns the bones' Y along the normal, and their Z."""
    if align == "NORMAL_DU":
        return frame[:, :, 2], -frame[:, :, 1]
    turn = native.limitsurf.shortest_turns(axes[:, :, 1], frame[:, :, 2])
    return frame[:, :, 2], np.einsum("nij,nj->ni", turn, axes[:, :, 2])


def _parents_first(armature: bpy.types.Armature) -> Iterable[bpy.types.EditBone]:
    return sorted(armature.edit_bones, key=lambda bone: len(bone.parent_recursive))


def _is_shown(bone: bpy.types.EditBone) -> bool:
    collections = bone.collections
    return not bone.hide and (
        not collections or any(each.is_visible_effectively for each in collections)
    )


def _is_head_chosen(bone: bpy.types.EditBone) -> bool:
    if bone.select:
        return True
    if bone.use_connect:
        return not bone.parent.select and (bone.select_head or bone.parent.select_tail)
    return bone.select_head
