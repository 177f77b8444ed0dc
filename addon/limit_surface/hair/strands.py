# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight strands on evaluated roots, as arrays."""

from dataclasses import dataclass

import numpy as np

from .. import native
from ..placing.rotations import WorldSpace, within_disc


@dataclass(frozen=True)
class Shape:
    """The shape of strands. What is steered has a row for each strand, or one for all."""

    length: np.ndarray  # (n, 1) in world units
    lean: np.ndarray  # (n, 2) angles in radians, towards the first two columns of the frames
    random: np.ndarray  # (n, 1) the largest random angle, in radians
    random_length: np.ndarray  # (n, 1) the largest part by which strands are shorter


class StrandMaker:
    """Makes strands part by part; the random numbers of a strand depend on those before it. Unless
    directions or lengths are random at all, no numbers are drawn for them.
    """

    def __init__(
        self, space: WorldSpace, seed: int, random_directions: bool, random_lengths: bool
    ) -> None:
        self._space = space
        self._directions = np.random.default_rng(seed) if random_directions else None
        self._lengths = np.random.default_rng([seed, 1]) if random_lengths else None

    def put(self, out: np.ndarray, root: np.ndarray, frame: np.ndarray, shape: Shape) -> None:
        """Writes control points to `out` (n, points, 3), an array in single precision: in the
        surface's space, evenly spaced from the roots. The frames (n, 3, 3) are in the world;
        strands that do not lean follow their last columns.
        """
        length, lean = shape.length, shape.lean
        if self._lengths is not None:
            shorter = shape.random_length * self._lengths.random((len(root), 1))
            length = length * (1 - shorter)
        if self._directions is not None:
            lean = lean + shape.random * within_disc(len(frame), self._directions)
        along = self._space.to_local(length * native.limitsurf.leaning(frame, lean))
        native.limitsurf.straight_strands(root, along, out.shape[1], out)
