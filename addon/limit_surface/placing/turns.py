# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations and directions of many elements at once."""

import numpy as np

from .rotations import unit


def shortest(source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Returns rotations (n, 3, 3) that turn unit vectors into others by the smallest angle, each
    made of two reflections: one reverses the source, the other exchanges that for the target. It is
    the identity where there is no source.
    """
    known = np.isfinite(source).all(axis=1)
    source = np.where(known[:, None], source, target)
    between = source + target
    opposite = np.linalg.norm(between, axis=1) < 1e-9
    between[opposite] = np.cross(source[opposite], _least_aligned_axis(source[opposite]))
    return _mirror(between) @ _mirror(source)


def _mirror(normal: np.ndarray) -> np.ndarray:
    normal = unit(normal)
    return np.eye(3) - 2 * normal[:, :, None] * normal[:, None, :]


def _least_aligned_axis(vectors: np.ndarray) -> np.ndarray:
    return np.eye(3)[np.argmin(np.abs(vectors), axis=1)]


def matrices(quaternions: np.ndarray) -> np.ndarray:
    """Returns rotations (n, 3, 3) for unit quaternions (n, 4), w x y z."""
    w, axis = quaternions[:, None, :1], quaternions[:, None, 1:]
    across = np.cross(axis, np.eye(3))
    return np.swapaxes(np.eye(3) + 2 * (w * across + np.cross(axis, across)), 1, 2)
