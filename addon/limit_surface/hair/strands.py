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
        roots, in single precision. The frames (n, 3, 3) are in the world; strands that do not lean
        follow their last columns.
        """
        shorter = shape.random_length * self._lengths.random((len(root), 1))
        length = shape.length * (1 - shorter)
        lean = shape.lean + shape.random * within_disc(len(frame), self._directions)
        along = self._space.to_local(length * native.limitsurf.leaning(frame, lean))
        return native.limitsurf.straight_strands(root, along, shape.points)
