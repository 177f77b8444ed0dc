# SPDX-License-Identifier: GPL-3.0-or-later
"""The move of one object to a place in the world through its own location and rotation.

Scale, delta transforms and parents do not change. Locks, constraints, drivers and parents without
extent may keep the object elsewhere, which shows only when Blender has evaluated the object again.
So `finish` checks where it is then, and restores it if it is somewhere else.
"""

import bpy
import numpy as np
from mathutils import Matrix

from .. import native
from ..placing.rotations import unit

# Tolerances for Blender's matrices in single precision: a share of the largest coordinate, and an
# angle
ELSEWHERE = 1e-5
ASKEW = 1e-3
FLAT = 1e-6  # what single precision leaves of a scale of 0, as a share of the largest scale

_ROTATIONS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
_LOCKED_TOGETHER = {"rotation_quaternion", "rotation_axis_angle"}


class ObjectMove:
    def __init__(
        self, ob: bpy.types.Object, position: np.ndarray, frame: np.ndarray, align: str
    ) -> None:
        self._ob, self._position, self._frame, self._align = ob, position, frame, align
        self._before = _array(ob.matrix_world)
        self._rotation = _ROTATIONS.get(ob.rotation_mode, "rotation_euler")
        self._kept = {name: tuple(getattr(ob, name)) for name in ("location", self._rotation)}

    def begin(self) -> None:
        ob = self._ob
        basis = _array(ob.matrix_basis)[:3, :3]
        self._of_parent = self._parent_matrix(basis)
        into_parent = np.linalg.pinv(self._of_parent)
        move = into_parent @ (self._position - self._before[:3, 3])
        ob.location = np.add(ob.location, move)
        scale = self._scale()
        if self._align != "NONE" and scale.all():
            rotation = basis / scale
            wanted = self._turned(rotation, into_parent @ self._frame, np.sign(scale))
            self._rotate(rotation.T @ wanted)

    def finish(self) -> str:
        """Returns, once Blender has evaluated the object, the reason why it is not where it should
        be, or None.
        """
        reason = self._obstacle()
        if reason:
            for name, value in self._kept.items():
                setattr(self._ob, name, value)
        return reason

    def _scale(self) -> np.ndarray:
        return np.multiply(self._ob.scale, self._ob.delta_scale)

    def _parent_matrix(self, basis: np.ndarray) -> np.ndarray:
        """Returns the matrix from directions in the space that the object's own location has to
        those in the world.
        """
        parent = self._ob.parent
        if not parent:
            return np.eye(3)
        if self._scale().all():  # whatever the parent is to the object: a vertex, a bone
            return self._before[:3, :3] @ np.linalg.pinv(basis)
        return _array(parent.matrix_world @ self._ob.matrix_parent_inverse)[:3, :3]

    def _is_out_of_reach(self, tolerance: float) -> bool:
        """Tells whether the object's own location cannot bring it to the place, because a parent
        has no extent in that direction.
        """
        move = self._position - self._before[:3, 3]
        within = self._of_parent @ np.linalg.pinv(self._of_parent, rcond=FLAT) @ move
        return bool(np.abs(within - move).max() > tolerance)

    def _turned(self, rotation: np.ndarray, frame: np.ndarray, sign: np.ndarray) -> np.ndarray:
        """Returns the rotation that puts the object's Z along the normal, all in its parent's
        space.
        """
        normal = unit(frame[:, 2])
        if self._align == "NORMAL":
            z = sign[2] * rotation[:, 2]
            return native.limitsurf.shortest_turns(z[None], normal[None])[0] @ rotation
        z = sign[2] * normal
        x = sign[0] * unit(frame[:, 0] - (frame[:, 0] @ normal) * normal)
        return np.stack([x, np.cross(z, x), z], axis=1)

    def _rotate(self, turn: np.ndarray) -> None:
        """Rotates in the space of the object's rotation, to which delta rotations are applied
        afterwards.
        """
        ob = self._ob
        was = getattr(ob, self._rotation)
        if self._rotation == "rotation_euler":
            turned = was.to_matrix() @ Matrix(turn)
            ob.rotation_euler = turned.to_euler(ob.rotation_mode, was)
        elif self._rotation == "rotation_quaternion":
            turned = (was.normalized().to_matrix() @ Matrix(turn)).to_quaternion()
            turned.make_compatible(was)
            ob.rotation_quaternion = turned
        else:
            angle, *axis = was
            turned = Matrix.Rotation(angle, 3, axis) @ Matrix(turn)
            axis, angle = turned.to_quaternion().to_axis_angle()
            ob.rotation_axis_angle = (angle, *axis)

    def _obstacle(self) -> str:
        if self._changes_what_is_locked():
            return "the location or rotation is locked"
        now = _array(self._ob.matrix_world)
        size = max(np.abs(self._position).max(), np.abs(self._before[:3, 3]).max())
        if not np.abs(now[:3, 3] - self._position).max() <= ELSEWHERE * size:
            if self._is_out_of_reach(ELSEWHERE * size):
                return "a parent has a scale of 0 in the direction of the move"
            if self._ob.parent and not self._scale().all():
                return "its scale is 0, and its parent is a bone or vertices of an object"
            return "constraints or drivers hold the object elsewhere"
        if self._align != "NONE":
            askew = np.cross(unit(now[:3, 2]), self._frame[:, 2])
            if not np.linalg.norm(askew) <= ASKEW:
                return "the object cannot be turned to the normal"
        return ""

    def _changes_what_is_locked(self) -> bool:
        locks = {"location": self._ob.lock_location}
        if self._align != "NONE":
            locks[self._rotation] = self._rotation_locks()
        for name, lock in locks.items():
            old, new = (np.array(value) for value in (self._kept[name], getattr(self._ob, name)))
            size = max(np.abs(old).max(), np.abs(new).max())
            if (np.abs(new - old) > ELSEWHERE * size)[np.array(lock)].any():
                return True
        return False

    def _rotation_locks(self) -> list[bool]:
        locks = list(self._ob.lock_rotation)
        if self._rotation in _LOCKED_TOGETHER:
            return [self._ob.lock_rotation_w, *locks]
        return locks


def _array(matrix: Matrix) -> np.ndarray:
    return np.array(matrix, np.float64)
