# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands as arrays, and the motion of their points when their roots move."""

import numpy as np

from ..placing.rotations import unit
from ..reading import ragged_rows


class Strands:
    """All points of some curves, one after another; each curve's first point is its root."""

    def __init__(self, points: np.ndarray, sizes: np.ndarray) -> None:
        self.points = points  # (n, 3)
        self.root = ragged_rows.starts(sizes)  # (m,) rows of the roots
        self.curve = np.repeat(np.arange(len(sizes)), sizes)  # (n,)
        self._last = self.root + sizes - 1

    def directions(self) -> np.ndarray:
        """Unit vectors (m, 3) from the roots to the second points; NaN where there is none."""
        second = np.minimum(self.root + 1, self._last)
        return unit(self.points[second] - self.points[self.root])

    def weights(self, mode: str) -> np.ndarray:
        """Returns for each point (n,) its share of the root's move."""
        if mode == "STRAND":
            return np.ones(len(self.points))
        if mode == "ROOT":
            weights = np.zeros(len(self.points))
            weights[self.root] = 1
            return weights
        along = self._along(np.linalg.norm(self._segments(self.points), axis=1))
        length = along[self._last]
        with np.errstate(invalid="ignore"):
            return np.where(length[self.curve] > 0, 1 - along / length[self.curve], 1)

    def moves(
        self, points: np.ndarray, root: np.ndarray, turn: np.ndarray, weights: np.ndarray
    ) -> np.ndarray:
        """Returns the moves (n, 3) of `points` that go with the strands, when the roots go to
        `root` and the strands turn about them.
        """
        arm = points - self.points[self.root][self.curve]
        turned = np.einsum("nij,nj->ni", turn[self.curve], arm) + root[self.curve]
        return weights[:, None] * (turned - points)

    def restored_lengths(self, moved: np.ndarray) -> np.ndarray:
        """Returns `moved` points (n, 3) in which the segments keep their directions and get the
        lengths that they had before.
        """
        lengths = np.linalg.norm(self._segments(self.points), axis=1, keepdims=True)
        segments = lengths * np.nan_to_num(unit(self._segments(moved)))
        return moved[self.root][self.curve] + self._along(segments)

    def _segments(self, points: np.ndarray) -> np.ndarray:
        """Returns the vectors (n, 3) to each point from the one before; 0 for roots."""
        segments = np.diff(points, axis=0, prepend=points[:1])
        segments[self.root] = 0
        return segments

    def _along(self, steps: np.ndarray) -> np.ndarray:
        """Returns the sums from the root to each point."""
        total = np.cumsum(steps, axis=0)
        return total - total[self.root][self.curve]
