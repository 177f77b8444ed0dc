# SPDX-License-Identifier: GPL-3.0-or-later
"""Calculates the image's numbers: the displacement at each texel's place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, cast

import numpy as np

from ..errors import RefusalError
from ..images import uv_tiles
from ..tasks.job import Progress, part_of
from . import layouts
from .layouts import PtexLayout, Texels, UvLayout
from .surfaces import Surfaces

PLACED = 0.4  # the part of a tile's progress at which its texels' places are known


@dataclass(frozen=True)
class Request:
    surfaces: Surfaces
    layout: UvLayout | PtexLayout
    is_vector: bool
    in_frames: bool
    max_distance: float
    direction: str  # BOTH, OUTWARD or INWARD: in lower case the words of the native module


@dataclass(frozen=True)
class Measured:
    tiles: dict[int, np.ndarray]  # pixels, (height, width, 4)
    count: int  # number of texels inside islands; those of the margin do not count here and below
    missing: int  # number of these at which nothing was met: they hold 0
    overlapping: int  # number of these that several places share
    lowest: float  # smallest distance, or length of a vector
    highest: float


def measure(request: Request, progress: Progress) -> Measured:
    """Raises RefusalError where no texel has a place, or nothing is met at all."""
    layout, tiles = request.layout, {}
    ranges, count, missing, overlapping = [], 0, 0, 0
    for i, tile in enumerate(layout.tiles):
        part = part_of(progress, i / len(layout.tiles), (i + 1) / len(layout.tiles))
        texels = layout.texels(tile, part_of(part, 0, PLACED))
        if not texels.inside.any():
            continue
        texels = layouts.with_surface(texels, request.surfaces.base)
        pixels = np.zeros((layout.height, layout.width, 4), np.float32)
        pixels[:, :, 3] = 1
        for _, some in layouts.parts(texels, part_of(part, PLACED, 1)):
            values, sizes = _measured(request, some)
            found = np.isfinite(sizes)
            pixels[some.y, some.x, :3] = np.where(found[:, None], values, 0)
            missing += int(np.count_nonzero(some.inside & ~found))
            counting = sizes[some.inside & found]
            if counting.size:
                ranges.append((counting.min(), counting.max()))
        count += int(np.count_nonzero(texels.inside))
        overlapping += int(texels.overlap.sum())
        tiles[tile] = pixels
    if not count:
        raise uv_tiles.no_texels(layout.tiles, layout.instead)
    if not ranges:
        raise RefusalError(
            f"No normal of the surface meets {request.surfaces.target.name} in the chosen "
            "direction and within the chosen distance"
        )
    lows, highs = zip(*ranges, strict=True)
    return Measured(tiles, count, missing, overlapping, float(min(lows)), float(max(highs)))


def _measured(request: Request, texels: Texels) -> tuple[np.ndarray, np.ndarray]:
    """Returns colors (n, 3), and the numbers (n,) of which the range is reported: NaN where nothing
    is met.
    """
    surfaces = request.surfaces
    base, target = surfaces.base, surfaces.sculpted
    if not request.is_vector:
        distances = base.scalar_displacement(
            target,
            texels.face,
            texels.uv,
            request.max_distance or np.inf,
            direction=cast(Literal["both", "outward", "inward"], request.direction.lower()),
        )
        return np.repeat(distances[:, None], 3, axis=1), distances
    frames = None
    if request.in_frames:
        assert surfaces.uv_data is not None
        frames = base.tangent_frames(surfaces.uv_data, texels.face, texels.uv)
    vectors = base.vector_displacement(target, texels.face, texels.uv, frames=frames)
    return vectors, np.linalg.norm(vectors, axis=1)
