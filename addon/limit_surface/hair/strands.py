# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight strands on evaluated roots, as arrays."""

from dataclasses import dataclass

import numpy as np

from ..placing.rotations import WorldSpace


@dataclass(frozen=True)
class Shape:
    length: float  # in world units
    points: int  # number of control points on each strand, including the root
    tilt: tuple[float, float]  # in radians, towards u and v
    random: float  # the largest random angle, in radians

    def strands(
        self, root: np.ndarray, frame: np.ndarray, space: WorldSpace, rng: np.random.Generator
    ) -> np.ndarray:
        """Control points (n, points, 3) in the surface's space, evenly spaced from the roots."""
        along = space.to_local(self.length * self._directions(space.frames(frame), rng))
        steps = np.linspace(0, 1, self.points)[None, :, None]
        return root[:, None, :] + steps * along[:, None, :]

    def _directions(self, frame: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Returns unit vectors: the normals, each turned towards its tilt by the tilt's size."""
        tilt = self.tilt + _within_disc(len(frame), self.random, rng)
        angle = np.linalg.norm(tilt, axis=1, keepdims=True)
        sideways = np.einsum("nij,nj->ni", frame[:, :, :2], tilt)
        # sin(angle) / angle, which is 1 where nothing is tilted
        return np.cos(angle) * frame[:, :, 2] + np.sinc(angle / np.pi) * sideways


def _within_disc(count: int, radius: float, rng: np.random.Generator) -> np.ndarray:
    """Points (n, 2), uniform in a disc."""
    distance, turn = rng.random((count, 2)).T
    turn *= 2 * np.pi
    return (radius * np.sqrt(distance))[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
