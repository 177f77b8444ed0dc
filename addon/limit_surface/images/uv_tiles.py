# SPDX-License-Identifier: GPL-3.0-or-later
"""The UDIM tiles that a UV map's faces lie in, and the faces that lie outside the tiles that an
image has.

A face counts as lying in a tile if it reaches farther into it than half a texel, because up to
there no texel's centre can lie inside it. So rounding at the border of a tile makes no tile.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..counting import counted
from ..errors import RefusalError
from ..reading import cage, ragged_rows
from .image_tiles import FIRST_TILE

if TYPE_CHECKING:
    import limitsurf

ACROSS, UP = 10, 100  # the tiles that have a UDIM number: 1001 to 2000
MOST_DOUBTFUL = 16  # tiles whose texels are looked for
MOVE_ISLANDS = "move its islands there"
_LAST = FIRST_TILE + ACROSS * UP - 1


def corner(tile: int) -> tuple[int, int]:
    """Returns the lower left corner of a UDIM tile on the map."""
    return (tile - FIRST_TILE) % ACROSS, (tile - FIRST_TILE) // ACROSS


def with_texels(
    found: cage.Cage, uv_data: Callable[[], limitsurf.SurfaceData], size: tuple[int, int]
) -> tuple[int, ...]:
    """Returns the tiles in which faces cover texels of images of that size. `uv_data` gives the map
    on the limit surface; it is called only where faces reach into tiles that have no others. Where
    these are many tiles, all of them are returned: it takes long to look at them, and rounding
    makes few.
    """
    faces = _tiles_of_faces(found, size)
    touched = _numbers(faces)
    whole = (faces.low == faces.high).all(axis=1)
    doubtful = touched - _numbers(_Cells(faces.low[whole], faces.high[whole]))
    if 0 < len(doubtful) <= MOST_DOUBTFUL:
        on_limit = uv_data()
        for tile in doubtful:
            if not on_limit.rasterize(*size, tile=corner(tile)).inside.any():
                touched.remove(tile)
    return tuple(sorted(touched))


def faces_outside(
    found: cage.Cage, size: tuple[int, int], tiles: Collection[int] | None = None
) -> int:
    """Counts the faces that lie wholly or partly outside these tiles, or outside all tiles that
    have a number.
    """
    faces = _tiles_of_faces(found, size)
    inside = np.zeros((UP + 2, ACROSS + 2), np.int64)  # with a border of what has no number
    if tiles is None:
        inside[1:-1, 1:-1] = 1
    for tile in tiles or ():
        across, up = corner(tile)
        inside[up + 1, across + 1] = 1
    sums = np.pad(inside.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    (x, y), (end_x, end_y) = faces.low.T + 1, faces.high.T + 2
    within = sums[end_y, end_x] - sums[y, end_x] - sums[end_y, x] + sums[y, x]
    return int((within < (end_x - x) * (end_y - y)).sum())


def no_texels(tiles: Collection[int], instead: str = "") -> RefusalError:
    """Returns the refusal of tiles none of which has texels inside islands. `instead` is what users
    can do if they do not want to move the islands.
    """
    where = f"tile {next(iter(tiles))}" if len(tiles) == 1 else "any of the tiles"
    remedy = f"{instead}, or {MOVE_ISLANDS}" if instead else MOVE_ISLANDS
    return RefusalError(f"The UV map covers no texel of {where}: {remedy}")


def told(count: int, tiles: Collection[int] | None = None) -> str:
    """Returns the warning about the faces that `faces_outside` has counted, or none."""
    if not count:
        return ""
    where = f"the tiles {FIRST_TILE} to {_LAST}" if tiles is None else "the image's tiles"
    if tiles is not None and set(tiles) == {FIRST_TILE}:
        where = f"tile {FIRST_TILE}"
    lie = counted(count, "faces", "lies", "lie")
    return f"{lie} wholly or partly outside {where} on the UV map: what is outside is left out"


class _Cells(NamedTuple):
    """The first and the last tile of each face, (n, 2) across and up. Where the first one is behind
    the last one the face lies on a border and is smaller than a texel.
    """

    low: np.ndarray
    high: np.ndarray


def _tiles_of_faces(found: cage.Cage, size: tuple[int, int]) -> _Cells:
    at = found.chosen_uv_map.values[found.chosen_uv_map.indices]
    starts = ragged_rows.starts(found.face_sizes)
    half = 0.5 / np.array(size)
    low = np.floor(np.minimum.reduceat(at, starts) + half)
    high = np.ceil(np.maximum.reduceat(at, starts) - half) - 1
    low, high = (of.clip(-1, (ACROSS, UP)).astype(int) for of in (low, high))
    return _Cells(np.minimum(low, high + 1), high)


def _numbers(faces: _Cells) -> set[int]:
    """Returns the numbers of the tiles that any of the faces lies in."""
    lies = (faces.low <= faces.high).all(axis=1)
    (x, y), (end_x, end_y) = faces.low[lies].T + 1, faces.high[lies].T + 2
    edges = np.zeros((UP + 3, ACROSS + 3), np.int64)
    for rows, columns, step in ((y, x, 1), (y, end_x, -1), (end_y, x, -1), (end_y, end_x, 1)):
        np.add.at(edges, (rows, columns), step)
    up, across = np.nonzero(edges.cumsum(axis=0).cumsum(axis=1)[1 : UP + 1, 1 : ACROSS + 1])
    return set((FIRST_TILE + across + ACROSS * up).tolist())
