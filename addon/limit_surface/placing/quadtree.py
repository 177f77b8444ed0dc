# SPDX-License-Identifier: GPL-3.0-or-later
"""All tiles of a surface, and for each face the quadtree that leads from (u, v) to its tile.

The library tells the tile of a location. The tree is found by asking it about the middle of cells:
a cell that its tile does not cover is split into four.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import limitsurf

NO_TILE = -(1 << 23)  # in `child`, for faces that have no limit surface; exact in single precision
_QUARTERS = np.array([[0, 0], [1, 0], [0, 1], [1, 1]])


@dataclass(frozen=True)
class Quadtree:
    """`child` of a node is the first of its four children, in the order (0, 0), (1, 0), (0, 1),
    (1, 1) of their upper halves in u and v, or -1 - tile. The first nodes are the faces.
    """

    child: np.ndarray  # (nodes,)
    tiles: limitsurf.Tiles
    origin: np.ndarray  # (tiles, 2) where each tile begins on its face
    levels: int  # the largest number of splits on the way to a tile


def build(surface: limitsurf.LimitSurface, max_depth: int) -> Quadtree:
    """Tiles are at least 2^-max_depth of a face wide, but for the first splits of faces that have
    several irregular vertices or sharp edges. What lies closer to an irregular vertex gets the tile
    beside it.
    """
    faces = np.flatnonzero(~np.isin(surface.base_face, list(surface.refused)))
    child = np.full(surface.face_count, NO_TILE)
    nodes, face, corner = faces, faces, np.zeros((len(faces), 2))
    leaves: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    levels = 0
    while True:
        size = 0.5**levels
        middle = corner + size / 2
        found = surface.tiles(face, middle, max_depth)
        begin = _origins(middle, found)
        end = begin + 1 / found.scale
        covers = ((begin <= corner) & (end >= corner + size)).all(axis=1) | found.moved
        leaves.append((nodes[covers], face[covers], middle[covers]))
        split = np.flatnonzero(~covers)
        if not len(split):
            break
        first = len(child) + 4 * np.arange(len(split))
        child[nodes[split]] = first
        child = np.concatenate([child, np.full(4 * len(split), NO_TILE)])
        nodes = (first[:, None] + np.arange(4)).ravel()
        face = np.repeat(face[split], 4)
        corner = (corner[split][:, None] + _QUARTERS * size / 2).reshape(-1, 2)
        levels += 1
    nodes, face, middle = (np.concatenate(parts) for parts in zip(*leaves, strict=True))
    tiles = surface.tiles(face, middle, max_depth)
    child[nodes] = -1 - tiles.tile
    origin = np.zeros((len(tiles.tile_points), 2))
    origin[tiles.tile[~tiles.moved]] = _origins(middle, tiles)[~tiles.moved]
    return Quadtree(child, tiles, origin, levels)


def _origins(uv: np.ndarray, tiles: limitsurf.Tiles) -> np.ndarray:
    return uv - tiles.tile_uv / tiles.scale
