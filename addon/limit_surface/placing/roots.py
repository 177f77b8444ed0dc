# SPDX-License-Identifier: GPL-3.0-or-later
"""The roots of strands and points: locations on the limit surface, evaluated part by part."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..tasks.job import Progress, slices

# Locations are evaluated in parts of this size, so that progress is shown and memory stays small.
PART = 1 << 16

#: A function from Ptex faces (n,) and uv (n, 2) to positions (n, 3) and frames (n, 3, 3)
Evaluate = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class Locations:
    face: np.ndarray  # (n,) int32, Ptex faces
    uv: np.ndarray  # (n, 2) float32

    def __len__(self) -> int:
        return len(self.face)


@dataclass(frozen=True)
class Roots:
    """The roots of the locations `rows`, evaluated in the surface's own space."""

    rows: slice
    position: np.ndarray  # (n, 3)
    frame: np.ndarray  # (n, 3, 3): columns tangent, normal x tangent, normal


def evaluate(on: Evaluate, locations: Locations, progress: Progress) -> Iterator[Roots]:
    for rows in slices(len(locations), PART, progress):
        face, uv = locations.face[rows], locations.uv[rows].astype(np.float64)
        yield Roots(rows, *on(face, uv))
