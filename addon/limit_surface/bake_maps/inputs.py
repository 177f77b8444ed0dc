# SPDX-License-Identifier: GPL-3.0-or-later
"""The inputs of a bake: what is read from Blender's data, and the surfaces that are made of it."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import RefusalError
from ..images import texel_places, uv_tiles
from ..reading import cage
from .bodies import Body
from .map_images import Order
from .maps import NORMAL_TANGENT, Settings
from .shading import Corners, Polygons


@dataclass(frozen=True)
class Inputs:
    found: cage.Cage
    whose: str
    corners: Corners | None
    in_world: bool
    maps: tuple[str, ...]
    settings: Settings
    size: tuple[int, int]
    tiles: tuple[int, ...]
    all_tiles: bool  # whether these are all in which the map has texels
    margin: int
    allow_overlap: bool
    is_encoded: bool

    @property
    def flat_faces(self) -> int:
        return texel_places.faces_without_area(self.found)

    @property
    def outside(self) -> str:
        """A warning about the faces outside the tiles that are baked, or none."""
        tiles = None if self.all_tiles else self.tiles
        return uv_tiles.told(uv_tiles.faces_outside(self.found, self.size, tiles), tiles)

    def order(self) -> Order:
        body = Body(self.found, self.whose, in_world=self.in_world)
        in_object = body
        if self.in_world and NORMAL_TANGENT in self.maps:
            in_object = Body(self.found, self.whose, in_world=False)
        return Order(
            body=body,
            in_object=in_object,
            polygons=Polygons(self.corners) if self.corners else None,
            maps=self.maps,
            settings=self.settings,
            size=self.size,
            tiles=self.tiles,
            instead="" if self.all_tiles else "set Tiles to All",
            margin=self.margin,
            allow_overlap=self.allow_overlap,
            is_encoded=self.is_encoded,
        )


def tiles_of(found: cage.Cage, whose: str, size: tuple[int, int]) -> tuple[int, ...]:
    """Returns all tiles in which the map has texels. Raises RefusalError where there are none."""
    tiles = uv_tiles.with_texels(
        found, lambda: texel_places.uv_data(found.surface(), found, whose), size
    )
    if not tiles:
        raise RefusalError(
            "The UV map covers no texel of the UDIM tiles 1001 to 2000: " + uv_tiles.MOVE_ISLANDS
        )
    return tiles
