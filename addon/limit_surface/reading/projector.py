# SPDX-License-Identifier: GPL-3.0-or-later
"""The place of an image in the world, and the direction in which it is projected.

A projector is a matrix from the world to clip space, as in OpenGL and Blender: x / w and y / w are
from -1 to 1 in the image, w is above 0 in front of the projector, and z / w is -1 and 1 at the two
depths between which it projects.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import transform


@dataclass(frozen=True)
class Projector:
    called: str  # its name in messages
    matrix: np.ndarray  # (4, 4)
    has_eye: bool  # whether all rays start at one point, which must not lie inside the surface

    def rays(self, st: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns the near and the far ends of rays, both (n, 3), through places (n, 2) of the
        image, which is [0, 1]^2 from its lower left corner.
        """
        flat = 2 * np.asarray(st, np.float64) - 1
        back = np.linalg.inv(self.matrix)
        near, far = (
            _divided(np.column_stack([flat, np.full(len(flat), z), np.ones(len(flat))]) @ back.T)
            for z in (-1.0, 1.0)
        )
        return near, far

    def places(self, points: np.ndarray) -> np.ndarray:
        """Returns the places in the image (n, 2) of points (n, 3) of the world."""
        clip = points @ self.matrix[:, :3].T + self.matrix[:, 3]
        return (_divided(clip)[:, :2] + 1) / 2


def inverse(matrix: np.ndarray, called: str) -> np.ndarray:
    """Raises RefusalError where an object's matrix has no inverse."""
    transform.check_invertible(matrix, called)
    return np.linalg.inv(matrix)


def fitted(size: tuple[float, float]) -> np.ndarray:
    """Returns the sides (2,) of an image of that size, scaled so that the longer side is 1."""
    return np.array(size, np.float64) / max(size)


def _divided(homogeneous: np.ndarray) -> np.ndarray:
    return homogeneous[:, :3] / homogeneous[:, 3:]
