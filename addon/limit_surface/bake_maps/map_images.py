# SPDX-License-Identifier: GPL-3.0-or-later
"""The pixels of all images that were ordered. Nothing here touches Blender's data."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..images import overlap, texel_places, uv_tiles
from ..tasks.job import Progress, part_of
from .bodies import Body, Places
from .maps import (
    AREA_DISTORTION,
    KINDS,
    NORMAL_TANGENT,
    Range,
    Settings,
    compared,
    encoded,
    mean_octave,
)
from .shading import Polygons

if TYPE_CHECKING:
    import limitsurf

MAPPED = 0.3  # the part of a tile's progress at which its texels are known
PAINTED = 1 << 16  # the texels that are painted at a time, which fit into the processor's cache


@dataclass(frozen=True)
class Order:
    body: Body  # the surface in the space of the maps
    in_object: Body  # the same surface, or one in the object's space
    polygons: Polygons | None  # set if a map in tangent space is made
    maps: tuple[str, ...]
    settings: Settings
    size: tuple[int, int]
    tiles: tuple[int, ...]
    instead: str  # what users can do where the map has no texels in these tiles
    margin: int
    allow_overlap: bool
    is_encoded: bool  # values are mapped to 0..1


class _Canvas:
    """Opaque pixels where values are painted, and transparent black ones elsewhere."""

    def __init__(self, width: int, height: int) -> None:
        # numpy asks for large pages for an array without values, not for one of zeros. To have the
        # system make a large image's memory page by page takes longer than to fill it.
        self.pixels = np.empty((height, width, 4), np.float32)
        self.pixels.fill(0)
        self._some = np.ones((PAINTED, 4), np.float32)
        # numpy moves a pixel at once where it takes it for one number of 16 bytes
        self._whole_pixels, self._whole_some = (
            of.reshape(-1, 4).view(np.complex128)[:, 0] for of in (self.pixels, self._some)
        )

    def paint(self, at: np.ndarray, values: np.ndarray) -> None:
        """Paints values (n, 3) or (n,) at these pixels, which are counted row by row."""
        for begin in range(0, len(values), PAINTED):
            part = values[begin : begin + PAINTED]
            self._some[: len(part), :3] = part if part.ndim == 2 else part[:, None]
            self._whole_pixels[at[begin : begin + PAINTED]] = self._whole_some[: len(part)]


@dataclass
class _Tile:
    texels: limitsurf.Texels
    values: dict[str, np.ndarray]  # (n, 3) or (n,) float32, of maps that depend on all values
    canvases: dict[str, _Canvas]  # of all others


@dataclass
class Baked:
    """The images by map and tile, and the meaning of their values."""

    pixels: dict[str, dict[int, np.ndarray]] = field(default_factory=dict)
    ranges: dict[str, Range] = field(default_factory=dict)  # ranges of the maps that are encoded
    texels: int = 0  # number of texels inside the islands of the UV map
    overlapping: int = 0
    without_values: int = 0  # number of values that have no limit, in all maps
    without_polygons: int = 0  # number of texels that lack a polygon for their tangent-space normal


def bake(order: Order, progress: Progress) -> Baked:
    made = Baked()
    tiles = {}
    for i, tile in enumerate(order.tiles):
        part = part_of(progress, 0.9 * i / len(order.tiles), 0.9 * (i + 1) / len(order.tiles))
        found = _values(order, tile, made, part)
        if found.texels.inside.any():
            tiles[tile] = found
    if not made.texels:
        raise uv_tiles.no_texels(order.tiles, order.instead)
    for name in order.maps:
        if name == AREA_DISTORTION:
            _compare(tiles)
        _paint(order, name, tiles, made)
    return made


def _values(order: Order, tile: int, made: Baked, progress: Progress) -> _Tile:
    mapping = part_of(progress, 0, MAPPED)
    texels = texel_places.texels(
        order.body.uv_map,
        order.size,
        tile,
        margin=order.margin,
        allow_overlap=order.allow_overlap,
        progress=part_of(mapping, 0, 0.5),
    )
    count = len(texels.x)
    made.texels += int(np.count_nonzero(texels.inside))
    made.overlapping += overlap.overlapping(texels)
    plain = [name for name in order.maps if name != NORMAL_TANGENT]
    at_once = [name for name in plain if not (order.is_encoded or name == AREA_DISTORTION)]
    made_of = _Tile(texels, {}, {name: _Canvas(*order.size) for name in at_once if count})
    values = made_of.values
    for rows in texel_places.parts(count, part_of(progress, MAPPED, 0.8)):
        places = Places(order.body, texels.face[rows], texels.uv[rows], order.settings.radius)
        at = _flat(texels, order.size[0], rows)
        for name in plain:
            found = KINDS[name].values(places, order.settings)
            if name in at_once:
                made_of.canvases[name].paint(at, _without_lost(found, made))
                continue
            if name not in values:
                values[name] = np.empty((count, *found.shape[1:]), np.float32)
            values[name][rows] = _without_lost(found, made)
    if order.polygons and count:
        found = _in_tangent_space(order, tile, texels, made, progress)
        values[NORMAL_TANGENT] = _without_lost(found, made)
    return made_of


def _without_lost(values: np.ndarray, made: Baked) -> np.ndarray:
    """Counts the texels whose values have no limit, and returns the values with 0 there."""
    finite = np.isfinite(values)
    if not finite.all():
        made.without_values += int(np.count_nonzero(~finite.reshape(len(values), -1).all(axis=1)))
        return np.where(finite, values, np.float32(0))
    return values


def _in_tangent_space(
    order: Order, tile: int, texels: limitsurf.Texels, made: Baked, progress: Progress
) -> np.ndarray:
    """Returns normals in tangent space. Where there are no polygons they point straight up: nothing
    is ever drawn there.
    """
    width, height = order.size
    assert order.polygons is not None
    shading = order.polygons.over(order.size, tile, order.margin, part_of(progress, 0.8, 0.9))
    row_at = np.full(width * height, -1, np.int32)
    row_at[_flat(shading.texels, width)] = np.arange(len(shading.texels.x), dtype=np.int32)
    rows = row_at[_flat(texels, width)]
    met = rows >= 0
    made.without_polygons += int(np.count_nonzero(texels.inside & ~met))
    out = np.zeros((len(rows), 3), np.float32)
    out[:, 2] = 1
    indices = np.flatnonzero(met)
    for part in texel_places.parts(len(indices), part_of(progress, 0.9, 1)):
        at = indices[part]
        places = Places(order.in_object, texels.face[at], texels.uv[at], order.settings.radius)
        out[at] = shading.tangent_space(rows[at], places.normal)
    return out


def _compare(tiles: dict[int, _Tile]) -> None:
    inside = [tile.values[AREA_DISTORTION][tile.texels.inside] for tile in tiles.values()]
    mean = mean_octave(np.concatenate(inside))
    for tile in tiles.values():
        tile.values[AREA_DISTORTION] = compared(tile.values[AREA_DISTORTION], mean)


def _paint(order: Order, name: str, tiles: dict[int, _Tile], made: Baked) -> None:
    """Moves the pixels of a map into `made`."""
    if order.is_encoded:
        inside = [tile.values[name][tile.texels.inside] for tile in tiles.values()]
        made.ranges[name] = KINDS[name].range(order.body, order.settings, np.concatenate(inside))
    made.pixels[name] = {}
    for number, tile in tiles.items():
        canvas = tile.canvases.pop(name, None)
        if canvas is None:
            values = tile.values.pop(name)
            if order.is_encoded:
                values = encoded(values, made.ranges[name])
            canvas = _Canvas(*order.size)
            canvas.paint(_flat(tile.texels, order.size[0]), values)
        made.pixels[name][number] = canvas.pixels


def _flat(texels: limitsurf.Texels, width: int, rows: slice = slice(None)) -> np.ndarray:
    """Returns the numbers of the texels' pixels, counted row by row."""
    return texels.y[rows].astype(np.int64) * width + texels.x[rows]
