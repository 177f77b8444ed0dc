# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature of an object's limit surface, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import RefusalError
from ..placing.rotations import WorldSpace, unit
from ..reading import cage
from ..tasks.job import Progress, slices

# Places are evaluated in parts of this size, so that progress is shown and memory stays small.
PART = 1 << 16
NOWHERE = -1  # the face of places that are on no surface


@dataclass(frozen=True)
class Values:
    """The curvature at some places. It is NaN where there is none."""

    mean: np.ndarray  # (n,)
    gaussian: np.ndarray
    k1: np.ndarray  # the larger principal curvature
    k2: np.ndarray
    direction1: np.ndarray  # (n, 3) unit vectors
    direction2: np.ndarray
    irregular: np.ndarray  # (n,) bool: an average around an irregular vertex

    @property
    def exist(self) -> np.ndarray:
        return np.isfinite(self.k1) & np.isfinite(self.k2)


class CurvedSurface:
    """A surface whose curvature is asked for: as it lies in the world if `in_world`, else in its
    object's space. The two differ: a stretched sphere has another curvature than a sphere, although
    both come from the same subdivision.
    """

    def __init__(self, found: cage.Cage, in_world: bool, radius: float) -> None:
        self.cage, self.in_world, self._radius = found, in_world, radius
        self.surface = found.surface(in_world=in_world)
        refused = self.surface.refused
        if len(refused) == len(found.face_sizes):
            raise RefusalError(f"No face has a limit surface: {next(iter(refused.values()))}")
        self._to_world = found.matrix
        self._is_inwards = False
        if in_world:
            WorldSpace(found.matrix, found.name)  # refuses objects whose scale is 0 along an axis
            self._to_world = np.eye(4)
            self._is_inwards = found.is_mirrored

    def values(
        self, face: np.ndarray, uv: np.ndarray, matrix: np.ndarray, progress: Progress
    ) -> Values:
        """Returns the values at locations; those with face NOWHERE get none. Directions are given
        in the space that `matrix` maps to the world.
        """
        count = len(face)
        numbers = np.full((4, count), np.nan)
        directions = np.full((2, count, 3), np.nan)
        irregular = np.zeros(count, bool)
        there = np.flatnonzero(face != NOWHERE)
        for part in slices(len(there), PART, progress):
            rows = there[part]
            c = self.surface.curvature(
                face[rows], uv[rows], irregular="average", radius=self._radius
            )
            if self._is_inwards:
                numbers[:, rows] = -c.mean, c.gaussian, -c.k2, -c.k1
                directions[:, rows] = c.direction2, c.direction1
            else:
                numbers[:, rows] = c.mean, c.gaussian, c.k1, c.k2
                directions[:, rows] = c.direction1, c.direction2
            irregular[rows] = c.irregular
        mean, gaussian, k1, k2 = numbers
        direction1, direction2 = self._seen_from(matrix, directions)
        return Values(mean, gaussian, k1, k2, direction1, direction2, irregular)

    def _seen_from(self, matrix: np.ndarray, directions: np.ndarray) -> np.ndarray:
        if np.array_equal(matrix, self._to_world):
            return directions
        relation = WorldSpace(matrix).to_local(self._to_world[:3, :3].T).T
        return unit(directions @ relation.T)
