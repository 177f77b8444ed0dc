# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight strands on evaluated roots, as arrays."""

from dataclasses import dataclass

import numpy as np

from ..placing.rotations import WorldSpace


@dataclass(frozen=True)
class Shape:
    """The shape of strands. What is steered has a row for each strand, or one for all."""

    length: np.ndarray  # (n, 1) in world units
    points: int  # number of control points on each strand, including the root
    lean: np.ndarray  # (n, 2) angles in radians, towards the first two columns of the frames
    random: np.ndarray  # (n, 1) the largest random angle, in radians
    random_length: np.ndarray  # (n, 1) the largest part by which strands are shorter


class StrandMaker:
    """Makes strands part by part; the random numbers of a strand depend on those before it."""

    def __init__(self, space: WorldSpace, seed: int) -> None:
        self._space = space
        self._directions = np.random.default_rng(seed)
        self._lengths = np.random.default_rng([seed, 1])

    def strands(self, root: np.ndarray, frame: np.ndarray, shape: Shape) -> np.ndarray:
        """Returns control points (n, points, 3) in the surface's space, evenly spaced from the
        roots. The frames (n, 3, 3) are in the world; strands that do not lean follow their last
        columns.
        """
        shorter = shape.random_length * self._lengths.random((len(root), 1))
        length = shape.length * (1 - shorter)
        along = self._space.to_local(length * self._leaning(frame, shape))
        steps = np.linspace(0, 1, shape.points)[None, :, None]
        return root[:, None, :] + steps * along[:, None, :]

    def _leaning(self, frame: np.ndarray, shape: Shape) -> np.ndarray:
        """Returns unit vectors: the last columns, each turned as it leans by the angle's size."""
        tilt = shape.lean + shape.random * _within_disc(len(frame), self._directions)
        angle = np.linalg.norm(tilt, axis=1, keepdims=True)
        sideways = np.einsum("nij,nj->ni", frame[:, :, :2], tilt)
        # sin(angle) / angle, which is 1 where nothing is tilted
        return np.cos(angle) * frame[:, :, 2] + np.sinc(angle / np.pi) * sideways


def _within_disc(count: int, rng: np.random.Generator) -> np.ndarray:
    """Points (n, 2), uniform in the unit disc."""
    distance, turn = rng.random((count, 2)).T
    turn *= 2 * np.pi
    return np.sqrt(distance)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
