# SPDX-License-Identifier: GPL-3.0-or-later
"""Where strands and points stand: locations on the limit surface, evaluated part by part."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import limitsurf

PART = 1 << 16  # so many are evaluated at once: a progress bar moves, memory stays small


@dataclass(frozen=True)
class Locations:
    face: np.ndarray  # (n,) int32, Ptex faces
    uv: np.ndarray  # (n, 2) float32

    def __len__(self) -> int:
        return len(self.face)


@dataclass(frozen=True)
class Roots:
    """Rows `rows` of all locations, evaluated, in the surface's own space."""

    rows: slice
    position: np.ndarray  # (n, 3)
    frame: np.ndarray  # (n, 3, 3): columns tangent, normal x tangent, normal


def scatter_jittered(surface: limitsurf.LimitSurface, per_side: int, seed: int) -> Locations:
    """per_side x per_side locations on each Ptex face.

    Files hold (u, v) in single precision, so it is rounded here, before anything is evaluated:
    a root lies exactly where its stored location says.
    """
    found = surface.scatter_jittered(per_side, seed)
    return Locations(np.asarray(found.face, np.int32), np.asarray(found.uv, np.float32))


def evaluate(
    surface: limitsurf.LimitSurface, locations: Locations, progress: Callable[[float], None]
) -> Iterator[Roots]:
    for begin in range(0, len(locations), PART):
        rows = slice(begin, min(begin + PART, len(locations)))
        face, uv = locations.face[rows], locations.uv[rows].astype(np.float64)
        yield Roots(rows, surface.evaluate(face, uv).position, surface.frames(face, uv))
        progress(rows.stop / len(locations))
