# SPDX-License-Identifier: GPL-3.0-or-later
"""The roots of strands and points: locations on the limit surface, evaluated part by part."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..tasks.job import Progress, slices

if TYPE_CHECKING:
    import limitsurf

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


# The distances from the vertices of their faces that places keep, as shares of a face: things that
# stand on the surface, and those beside it, which turn about their place.
_ON, _BESIDE = 2.0**-22, 2.0**-12


def off_vertices(uv: np.ndarray, on_surface: np.ndarray | bool = True) -> np.ndarray:
    """Returns uv (n, 2), where places very close to a vertex of their face are put a little further
    inside the face. What stands on the surface moves by less than single precision can tell.

    At a vertex the normal may have no limit, and in single precision the frame is lost before it:
    at a rounded corner du and dv are almost parallel.
    """
    distance = np.where(on_surface, _ON, _BESIDE)[..., None]
    from_side = np.minimum(uv, 1 - uv)
    near = (from_side < distance).all(axis=1, keepdims=True)
    return np.where(near, np.where(uv < 0.5, distance, 1 - distance), uv)


@dataclass(frozen=True)
class Roots:
    """The roots of the locations `rows`, evaluated in the surface's own space."""

    rows: slice
    position: np.ndarray  # (n, 3)
    frame: np.ndarray  # (n, 3, 3): columns tangent, normal x tangent, normal


def on_surface(surface: limitsurf.LimitSurface) -> Evaluate:
    """Returns the function that finds places on the surface itself, in its space."""

    def places(face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        placed = surface.placed_frames(face, uv)
        return placed.position, placed.frame

    return places


def evaluate(on: Evaluate, locations: Locations, progress: Progress) -> Iterator[Roots]:
    for rows in slices(len(locations), PART, progress):
        face, uv = locations.face[rows], locations.uv[rows].astype(np.float64)
        yield Roots(rows, *on(face, uv))
