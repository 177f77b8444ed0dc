# SPDX-License-Identifier: GPL-3.0-or-later
"""Layouts tell which place of the surface each texel of the image stands for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np

from .. import native
from ..errors import RefusalError, TooLargeError
from ..images import texel_places, uv_tiles
from ..images.image_pixels import FIRST_TILE
from ..tasks.job import Progress
from .surfaces import Surfaces

if TYPE_CHECKING:
    import limitsurf


class Texels(NamedTuple):
    x: np.ndarray
    y: np.ndarray  # counted upwards
    face: np.ndarray
    uv: np.ndarray
    inside: np.ndarray  # whether it lies on the map, and not only in its margin
    overlap: np.ndarray  # whether several places share it


@dataclass(frozen=True)
class UvLayout:
    uv_data: limitsurf.SurfaceData
    width: int
    height: int
    tiles: tuple[int, ...]
    instead: str  # what users can do where the map has no texels in these tiles
    margin: int
    allow_overlap: bool

    def texels(self, tile: int, progress: Progress) -> Texels:
        found = texel_places.texels(
            self.uv_data,
            (self.width, self.height),
            tile,
            margin=self.margin,
            allow_overlap=self.allow_overlap,
            progress=progress,
        )
        return Texels(found.x, found.y, found.face, found.uv, found.inside, found.overlap)


@dataclass(frozen=True)
class PtexLayout:
    layout: limitsurf.PtexLayout
    tiles = (FIRST_TILE,)
    instead = ""

    @property
    def width(self) -> int:
        return self.layout.width

    @property
    def height(self) -> int:
        return self.layout.height

    def texels(self, _tile: int, _progress: Progress) -> Texels:
        found = self.layout.texels()
        inside = np.ones(len(found.x), bool)
        return Texels(found.x, found.y, found.face, found.uv, inside, ~inside)

    def described(self) -> dict[str, int]:
        """Describes all that is needed to find a place's texel."""
        layout = self.layout
        return {
            "face_count": layout.face_count,
            "resolution": layout.resolution,
            "columns": layout.columns,
        }


def of(
    properties: bpy.types.OperatorProperties, surfaces: Surfaces, whose: str
) -> UvLayout | PtexLayout:
    """Raises RefusalError where the image cannot be made, or is larger than users expect."""
    if properties.layout_kind == "PTEX":
        try:
            layout = native.limitsurf.PtexLayout(
                surfaces.base.face_count, int(properties.face_resolution)
            )
        except ValueError as error:
            raise TooLargeError(native.sentence(error)) from error
        texel_places.check_size(layout.width, layout.height, 1, 1, properties.allow_large)
        return PtexLayout(layout)
    uv_data, size = surfaces.uv_data, (properties.width, properties.height)
    assert uv_data is not None
    tiles: tuple[int, ...] = (FIRST_TILE,)
    if properties.use_tiles:
        tiles = uv_tiles.with_texels(surfaces.found, lambda: uv_data, size)
    if not tiles:
        raise RefusalError(
            f"{whose}: the UV map {surfaces.found.chosen_uv_map.name} covers no texel of the UDIM "
            f"tiles 1001 to 2000: {uv_tiles.MOVE_ISLANDS}"
        )
    texel_places.check_size(*size, len(tiles), 1, properties.allow_large)
    return UvLayout(
        uv_data,
        *size,
        tiles,
        "" if properties.use_tiles else "turn UDIM Tiles on",
        properties.margin,
        properties.overlap == "ALLOW",
    )


def with_surface(texels: Texels, surface: limitsurf.LimitSurface) -> Texels:
    """Drops the texels on faces that have no limit surface."""
    if not surface.refused:
        return texels
    keep = ~np.isin(surface.base_face[texels.face], list(surface.refused))
    return Texels(*(column[keep] for column in texels))


def parts(texels: Texels, progress: Progress) -> Iterator[tuple[slice, Texels]]:
    """Yields the texels in parts, one after the other."""
    for rows in texel_places.parts(len(texels.x), progress):
        yield rows, Texels(*(column[rows] for column in texels))
