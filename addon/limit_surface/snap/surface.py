# SPDX-License-Identifier: GPL-3.0-or-later
"""The limit surface that things are snapped to, as it stands in the world."""

from typing import Literal, NamedTuple

import bpy
import numpy as np

from ..placing.rotations import WorldSpace
from ..reading import cage, displayed_mesh, rules
from ..tasks.refused_faces import check_some_left

SAME = 1e-6  # of the largest coordinate: as exactly as Blender's single precision allows


class Places(NamedTuple):
    position: np.ndarray  # (n, 3)
    frame: np.ndarray  # (n, 3, 3) rotations: columns tangent, normal x tangent, outward normal


class TargetSurface:
    """Queries are made on the surface of the cage's world-space positions: closest and at right
    angles mean something else in the space of a stretched object, and subdivision does not mind."""

    def __init__(
        self,
        ob: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        kind: displayed_mesh.Kind | Literal["LIMIT"],
    ) -> None:
        self.ob = ob
        self._stood = ob.matrix_world.copy()
        self.cage = cage.read(ob, depsgraph)
        WorldSpace(self.cage.matrix)  # refuses what is flattened to nothing
        self.in_world = self.cage.surface(in_world=True)
        check_some_left(self.in_world, ob.name)
        self._in_object = self.cage.surface()
        self._shown = (
            None if kind == "LIMIT" else displayed_mesh.read(ob, depsgraph, self.cage, kind)
        )
        self.outward = -1.0 if self.cage.is_mirrored else 1.0

    def has_changed(self, depsgraph: bpy.types.Depsgraph) -> bool:
        """Since it was read: what was put on it has a part in it."""
        if self.ob.matrix_world != self._stood:
            return True
        if not self.ob.modifiers or self.ob.modifiers[0] == rules.find_subsurf(self.ob):
            return False
        now, before = cage.read(self.ob, depsgraph).mesh.positions, self.cage.mesh.positions
        return now.shape != before.shape or np.abs(now - before).max() > SAME * np.abs(before).max()

    def size(self) -> float:
        """Of the largest coordinate that positions in the world are calculated with."""
        return float(np.abs(self.in_world.positions).max())

    def places(self, face: np.ndarray, uv: np.ndarray, space: np.ndarray) -> Places:
        """Where things are put, in the space that the matrix `space` leads from to the world.

        Frames are the limit surface's even on polygons, which would have kinks between them.
        """
        surface = self._in_object
        position = self._positions(face, uv)
        frame = surface.frames(face, uv)
        if np.array_equal(space, self.cage.matrix):
            return Places(position, frame)
        relation = np.linalg.solve(space, self.cage.matrix)
        seen = WorldSpace(relation).frames(frame)
        seen[:, :, 1] = np.cross(seen[:, :, 2], seen[:, :, 0])
        return Places(transformed(relation, position), seen)

    def surface_uv(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray | None:
        """On the UV map of the mesh that the viewport shows, as new hair stores it."""
        found = self.cage.uv_map
        if found is None:
            return None
        shown = self._in_object.face_varying(
            found.values, found.indices, self.cage.shown_uv_interpolation
        )
        return shown.evaluate(face, uv).value

    def _positions(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        if self._shown is None:
            return self._in_object.evaluate(face, uv).position
        return self._shown.positions(face, uv)


def transformed(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    return points @ matrix[:3, :3].T + matrix[:3, 3]
