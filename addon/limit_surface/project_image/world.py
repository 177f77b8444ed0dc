# SPDX-License-Identifier: GPL-3.0-or-later
"""The limit surface in world space, in which distances and angles are measured."""

from __future__ import annotations

import numpy as np

from ..errors import RefusalError
from ..placing.rotations import WorldSpace
from ..reading import cage
from ..reading.projector import Projector
from ..tasks.refused_faces import check_some_left

MIRROR = np.diag([-1.0, 1, 1, 1])


class WorldSurface:
    """`surface` has the positions in the world. For a mirrored object it has those of the world's
    mirror image, so that du x dv points outward. `local` has the positions in the object's space.
    """

    def __init__(self, found: cage.Cage, called: str) -> None:
        self.cage = found
        self.axes = WorldSpace(found.matrix, called)  # refuses a scale of 0
        self.from_world = MIRROR if found.is_mirrored else np.eye(4)
        self.surface, self.local = found.surface(), found.surface()
        check_some_left(self.surface, called)
        self.surface.set_positions(self.to_surface(found.world_positions()))

    def to_surface(self, points: np.ndarray) -> np.ndarray:
        """Converts points (n, 3) of the world to the surface's space."""
        return points @ self.from_world[:3, :3].T

    def clip_matrix(self, projector: Projector) -> np.ndarray:
        """Returns the matrix from the surface's space to the projector's clip space."""
        return projector.matrix @ np.linalg.inv(self.from_world)

    def check_eye(self, projector: Projector) -> None:
        """Raises RefusalError for a projector from which nothing can be seen."""
        try:
            is_inside = self.surface.eye_is_inside(self.clip_matrix(projector))
        except ValueError as error:  # no matrix in double precision can hold both
            raise RefusalError(
                f"{projector.called} and the surface are too far apart, or too different in size"
            ) from error
        if projector.has_eye and is_inside:
            raise RefusalError(f"{projector.called} is inside the surface: move it outside")

    def bounds(self) -> np.ndarray:
        """The bounds (2, 3) in the world."""
        return np.sort(self.to_surface(self.surface.bounds()), axis=0)
