# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames and directions in world space."""

import numpy as np

from .. import native
from ..reading import transform


def unit(vectors: np.ndarray) -> np.ndarray:
    """Returns unit vectors along the last axis; NaN for vectors without a direction."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def within_disc(count: int, rng: np.random.Generator) -> np.ndarray:
    """Returns points (n, 2), uniform in the unit disc."""
    distance, turn = rng.random((count, 2)).T
    turn *= 2 * np.pi
    return np.sqrt(distance)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)


class WorldSpace:
    """Converts frames of an object's surface to world space, whatever the object's scale."""

    def __init__(self, matrix: np.ndarray, called: str = "The object") -> None:
        """Raises RefusalError, with the object's name in messages, for a matrix that has no
        inverse.
        """
        transform.check_invertible(matrix, called)
        self._linear = matrix[:3, :3]
        self._inverse = np.linalg.inv(self._linear)
        singular_values = np.linalg.svd(self._linear, compute_uv=False)
        self.mean_scale = float(np.cbrt(singular_values.prod()))

    def frames(self, frame: np.ndarray) -> np.ndarray:
        """Returns frames with the columns tangent, across and normal. They are orthonormal, the
        normal points outward, and `across` points to the side of growing v (on a mirrored object
        such a frame is left-handed).
        """
        return native.limitsurf.frames_in_world(frame, self._linear)

    def to_local(self, vectors: np.ndarray) -> np.ndarray:
        return vectors @ self._inverse.T
