# SPDX-License-Identifier: GPL-3.0-or-later
"""Where an image lies in the world, and which way it is thrown.

A projector is a matrix from the world to clip space, as OpenGL and Blender have it: the image is
x / w and y / w from -1 to 1, w is above 0 in front of it, and z / w is -1 and 1 at the two depths
between which it works.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import RefusalError

SINGULAR = 1e-12  # of the largest singular value


@dataclass(frozen=True)
class Projector:
    called: str  # in messages
    matrix: np.ndarray  # (4, 4)
    has_eye: bool  # rays leave one place, which must not lie inside the surface

    def rays(self, st: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """From the near end to the far one, both (n, 3), through places (n, 2) of the image, which
        is [0, 1]^2 from its lower left corner."""
        flat = 2 * np.asarray(st, np.float64) - 1
        back = np.linalg.inv(self.matrix)
        near, far = (
            _divided(np.column_stack([flat, np.full(len(flat), z), np.ones(len(flat))]) @ back.T)
            for z in (-1.0, 1.0)
        )
        return near, far

    def places(self, points: np.ndarray) -> np.ndarray:
        """Of points (n, 3) of the world, in the image (n, 2)."""
        clip = points @ self.matrix[:, :3].T + self.matrix[:, 3]
        return (_divided(clip)[:, :2] + 1) / 2


def inverse(matrix: np.ndarray, called: str) -> np.ndarray:
    """RefusalError where an object is scaled to nothing along an axis."""
    values = np.linalg.svd(matrix[:3, :3], compute_uv=False)
    if not values[-1] > SINGULAR * values[0]:
        raise RefusalError(f"{called} is flattened to nothing: its scale is 0 along an axis")
    return np.linalg.inv(matrix)


def fitted(size: tuple[float, float]) -> np.ndarray:
    """Sides (2,) of an image of that size, the longer of which is 1."""
    return np.array(size, np.float64) / max(size)


def _divided(homogeneous: np.ndarray) -> np.ndarray:
    return homogeneous[:, :3] / homogeneous[:, 3:]
