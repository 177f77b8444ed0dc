# SPDX-License-Identifier: GPL-3.0-or-later
"""The limit surface in world space to which things are snapped."""

from __future__ import annotations

from typing import Literal

import bpy
import numpy as np

from ..errors import RefusalError
from ..placing import following
from ..placing.posed_surface import SAME, Places, PosedSurface, positions_seen_from, seen_from
from ..reading import cage, displayed_mesh
from ..tasks.object_keys import ObjectKey
from ..tasks.refused_faces import check_some_left
from ..tasks.unchanged import AGAIN, Unchanged


class TargetSurface:
    """The surface made from the cage's positions in world space, because the closest point and
    right angles are different in the space of a stretched object. Subdivision gives the same
    surface in both spaces.
    """

    def __init__(
        self,
        ob: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        kind: displayed_mesh.Kind | Literal["LIMIT"],
    ) -> None:
        # undo may take all objects away while something is dragged
        self._key, self._unchanged, self._kind = ObjectKey.of(ob), Unchanged(ob), kind
        self._stood = ob.matrix_world.copy()
        self.cage = cage.read(ob, depsgraph)
        posed = PosedSurface(self.cage)
        self.in_world = posed.in_world
        check_some_left(self.in_world, ob.name)
        self._in_object = posed.in_object
        self._shown = (
            None if kind == "LIMIT" else displayed_mesh.read(ob, depsgraph, self.cage, kind)
        )
        self.outward = -1.0 if self.cage.is_mirrored else 1.0

    @property
    def ob(self) -> bpy.types.Object:
        """Raises RefusalError if the object has been removed."""
        return self._key.find()

    def now(self, depsgraph: bpy.types.Depsgraph) -> TargetSurface:
        """Returns the surface of the same object as it is by now. Raises RefusalError if its faces
        have changed, so that locations on them mean other places.
        """
        self._unchanged.check()
        ob, before = self.ob, self.cage
        found = cage.read(ob, depsgraph)
        signatures = following.signature(before), following.signature(found)
        if not following.have_same_faces(*signatures):
            raise RefusalError(f"The faces of {ob.name} were changed meanwhile: {AGAIN}")
        is_same = (
            self._shown is None
            and signatures[0] == signatures[1]
            and np.array_equal(before.matrix, found.matrix)
            and np.array_equal(before.mesh.positions, found.mesh.positions)
        )
        return self if is_same else TargetSurface(ob, depsgraph, self._kind)

    def has_changed(self, depsgraph: bpy.types.Depsgraph) -> bool:
        """Tells whether the surface lies elsewhere than when it was read. Where nothing else can
        have changed since, it depends on what was put on it: by its constraints, its drivers, which
        also move shape keys, or its modifiers.
        """
        ob = self.ob
        if ob.matrix_world != self._stood:
            return True
        now, before = cage.read(ob, depsgraph).mesh.positions, self.cage.mesh.positions
        return now.shape != before.shape or np.abs(now - before).max() > SAME * np.abs(before).max()

    def size(self) -> float:
        """The largest coordinate that occurs in the calculation of positions in the world."""
        return float(np.abs(self.in_world.positions).max())

    def places(
        self, face: np.ndarray, uv: np.ndarray, space: np.ndarray, on_limit: bool = False
    ) -> Places:
        """Returns where things are put, in the space that the matrix `space` maps to the world.
        With `on_limit` these are places on the limit surface even where things are put on polygons.

        Frames are those of the limit surface even on polygons, which would have kinks between them.
        """
        if self._shown is None or on_limit:
            placed = self._in_object.placed_frames(face, uv)
            places = Places(placed.position, placed.frame)
        else:
            frame = self._in_object.frames(face, uv)
            places = Places(self._shown.positions(face, uv), frame)
        return seen_from(space, places, self.cage.matrix)

    def positions(self, face: np.ndarray, uv: np.ndarray, space: np.ndarray) -> np.ndarray:
        """Returns the positions of `places` alone, which are found in less time."""
        if self._shown is None:
            found = self._in_object.evaluate(face, uv).position
        else:
            found = self._shown.positions(face, uv)
        return positions_seen_from(space, found, self.cage.matrix)

    def surface_uv(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray | None:
        return self.cage.surface_uv(self._in_object, face, uv)
