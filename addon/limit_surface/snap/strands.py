# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands as arrays: how their points follow when their roots move."""

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
        """(m, 3) unit vectors from the roots to the second points; NaN where there is none."""
        second = np.minimum(self.root + 1, self._last)
        return unit(self.points[second] - self.points[self.root])

    def weights(self, mode: str) -> np.ndarray:
        """(n,) how much of its root's move each point shares."""
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
        """(n, 3) of `points` that go with the strands' own, when the roots go to `root` and the
        strands turn about them."""
        arm = points - self.points[self.root][self.curve]
        turned = np.einsum("nij,nj->ni", turn[self.curve], arm) + root[self.curve]
        return weights[:, None] * (turned - points)

    def restored_lengths(self, moved: np.ndarray) -> np.ndarray:
        """(n, 3) of `moved` points, whose segments keep their directions and get the lengths that
        they had before."""
        lengths = np.linalg.norm(self._segments(self.points), axis=1, keepdims=True)
        segments = lengths * np.nan_to_num(unit(self._segments(moved)))
        return moved[self.root][self.curve] + self._along(segments)

    def _segments(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) to each point from the one before; 0 for roots."""
        segments = np.diff(points, axis=0, prepend=points[:1])
        segments[self.root] = 0
        return segments

    def _along(self, steps: np.ndarray) -> np.ndarray:
        """Sums from the root to each point."""
        total = np.cumsum(steps, axis=0)
        return total - total[self.root][self.curve]
