# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames in Blender's form: quaternions, and directions in world space."""

import numpy as np

from ..errors import RefusalError


def quaternions(rotation: np.ndarray) -> np.ndarray:
    """Returns rotation matrices (n, 3, 3) as unit quaternions (n, 4), w x y z, w >= 0.

    Each row of `candidates` is the quaternion times four times one of its own components. The row
    with the largest component is taken, so that no digits cancel.
    """
    r = rotation
    trace = np.einsum("nii->n", r)
    candidates = np.empty((len(r), 4, 4))
    candidates[:, 0, 0] = 1 + trace
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        candidates[:, i + 1, i + 1] = 1 + 2 * r[:, i, i] - trace
        candidates[:, 0, i + 1] = candidates[:, i + 1, 0] = r[:, k, j] - r[:, j, k]
        candidates[:, j + 1, k + 1] = candidates[:, k + 1, j + 1] = r[:, j, k] + r[:, k, j]
    largest = np.argmax(np.einsum("nii->ni", candidates), axis=1)
    chosen = candidates[np.arange(len(r)), largest]
    chosen *= np.where(chosen[:, :1] < 0, -1, 1)
    return unit(chosen)


def unit(vectors: np.ndarray) -> np.ndarray:
    """Returns unit vectors along the last axis; NaN for vectors without a direction."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def leaning(frame: np.ndarray, lean: np.ndarray) -> np.ndarray:
    """Returns unit vectors (n, 3): the last columns of frames (n, 3, 3), each turned towards the
    first two columns by angles (n, 2) in radians.
    """
    angle = np.linalg.norm(lean, axis=1, keepdims=True)
    sideways = np.einsum("nij,nj->ni", frame[:, :, :2], lean)
    # sin(angle) / angle, which is 1 where nothing leans
    return np.cos(angle) * frame[:, :, 2] + np.sinc(angle / np.pi) * sideways


def within_disc(count: int, rng: np.random.Generator) -> np.ndarray:
    """Returns points (n, 2), uniform in the unit disc."""
    distance, turn = rng.random((count, 2)).T
    turn *= 2 * np.pi
    return np.sqrt(distance)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)


class WorldSpace:
    """Converts frames of an object's surface to world space, whatever the object's scale."""

    def __init__(self, matrix: np.ndarray) -> None:
        self._linear = matrix[:3, :3]
        self._handedness = np.sign(np.linalg.det(self._linear))
        singular_values = np.linalg.svd(self._linear, compute_uv=False)
        if singular_values[-1] <= 1e-12 * singular_values[0]:
            raise RefusalError("The object has a scale of 0 along an axis")
        self._inverse = np.linalg.inv(self._linear)
        self.mean_scale = float(np.cbrt(singular_values.prod()))

    def frames(self, frame: np.ndarray) -> np.ndarray:
        """Returns frames with the columns tangent, across and normal. They are orthonormal, the
        normal points outward, and `across` points to the side of growing v (on a mirrored object
        such a frame is left-handed).
        """
        tangent = unit(frame[:, :, 0] @ self._linear.T)
        normal = unit(frame[:, :, 2] @ self._inverse)
        across = self._handedness * np.cross(normal, tangent)
        return np.stack([tangent, across, normal], axis=2)

    def to_local(self, vectors: np.ndarray) -> np.ndarray:
        return vectors @ self._inverse.T
