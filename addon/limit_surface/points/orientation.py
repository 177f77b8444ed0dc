# SPDX-License-Identifier: GPL-3.0-or-later
"""The rotations and sizes of what stands on points, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import native
from ..placing.rotations import unit, within_disc


@dataclass(frozen=True)
class Pose:
    """How instances are turned and how large they are: a row for each, or one for all."""

    along: np.ndarray | None  # (n, 3) where their X axis points to; zeros leave it alone
    into: np.ndarray | None  # (n, 3) where their Z axis leans to, by angles of this length
    rotation: np.ndarray  # (n, 1) angle about the Z axis
    tilt: np.ndarray  # (n, 2) angles towards the X axis and the Y axis
    scale: np.ndarray  # (n, 1)
    random: np.ndarray  # (n, 1) the largest random angle of the tilt
    random_rotation: np.ndarray  # (n, 1) the largest random angle about the Z axis
    random_scale: np.ndarray  # (n, 1) the largest part by which instances are smaller


class Poser:
    """Turns frames part by part; the random numbers of a point depend on those before it."""

    def __init__(self, seed: int) -> None:
        self._tilts, self._rotations, self._scales = (
            np.random.default_rng([seed, stream]) for stream in (2, 3, 4)
        )

    def scales(self, pose: Pose, count: int) -> np.ndarray:
        """Returns factors (n, 1)."""
        return pose.scale * (1 - pose.random_scale * self._scales.random((count, 1)))

    def turned(self, frame: np.ndarray, pose: Pose) -> np.ndarray:
        """Returns rotations (n, 3, 3) whose columns are the axes of instances. Their Z axis is the
        last column of the frames, unless it leans.
        """
        count = len(frame)
        if pose.along is not None:
            frame = _directed(frame, pose.along)
        either_side = 2 * self._rotations.random((count, 1)) - 1
        frame = _about_z(frame, pose.rotation + pose.random_rotation * either_side)
        lean = pose.tilt + pose.random * within_disc(count, self._tilts)
        if pose.into is not None:
            lean = lean + np.einsum("nij,ni->nj", frame[:, :, :2], pose.into)
        if not lean.any():
            return frame
        leaning = native.limitsurf.leaning(frame, lean)
        turn = native.limitsurf.shortest_turns(frame[:, :, 2], leaning)
        return turn @ frame


def _directed(frame: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Returns frames whose first columns point along these directions, as far as the last columns
    allow it.
    """
    z = frame[:, :, 2]
    x = along - np.einsum("ni,ni->n", along, z)[:, None] * z
    x = np.where(np.linalg.norm(x, axis=1, keepdims=True) > _NOWHERE, x, frame[:, :, 0])
    x = unit(x)
    return np.stack([x, np.cross(z, x), z], axis=2)


def _about_z(frame: np.ndarray, angle: np.ndarray) -> np.ndarray:
    if not angle.any():
        return frame
    x, y, z = np.moveaxis(frame, 2, 0)
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.stack([cosine * x + sine * y, cosine * y - sine * x, z], axis=2)


_NOWHERE = 1e-6  # flows that are shorter have no direction
