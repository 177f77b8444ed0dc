# SPDX-License-Identifier: GPL-3.0-or-later
"""A cage with its UV map, and the places of an image's texels on the limit surface. All operators
that make textures use them.

    found = texel_places.read_cage(ob, depsgraph, "UVMap")          # "" for the active map
    surface = limitsurf.LimitSurface(found.mesh)
    uv_data = texel_places.uv_data(surface, found, ob.name)         # the map on the limit
    at = texel_places.texels(uv_data, (1024, 1024), margin=16)      # at.x, at.y, at.face, at.uv
    for rows in texel_places.parts(len(at.x), progress): ...  # part by part
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..counting import counted
from ..errors import RefusalError, TooLargeError
from ..reading import cage, ragged_rows, uv_map
from ..tasks.job import Progress, slices
from ..tasks.request_size import LARGE_MEMORY, memory_text
from . import overlap, uv_tiles
from .image_pixels import FIRST_TILE

if TYPE_CHECKING:
    import limitsurf

# Texels are evaluated in parts of this size, so that progress is shown and memory stays small.
PART = 1 << 18

# Beyond, rounding would move texels: the map's farthest point limits how exact all others are.
FARTHEST = 1e8

BYTES_PER_TEXEL = 40  # bytes that a texel's place on the surface takes, measured at the peak
BYTES_PER_PIXEL = 32  # bytes that a texel of each image takes, with its source and its packed copy


def read_cage(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph, name: str = "") -> cage.Cage:
    """Reads the object's cage with the UV map of that name, or the active one. Raises RefusalError
    where there is none, or it has no area.
    """
    with cage.opened(ob, depsgraph) as (found, mesh):
        if name:
            found = replace(found, uv_map=_named(ob, mesh, name), without_uv_map="")
    check_uv_map(found, ob.name)
    return found


def check_uv_map(found: cage.Cage, whose: str) -> None:
    """Raises RefusalError where the cage has no UV map, or one that reaches too far, or none of its
    faces has an area on it.
    """
    if found.uv_map is None:
        raise RefusalError(f"{whose}: {found.without_uv_map or 'there is no UV map'}")
    reach = np.abs(found.uv_map.values).max(initial=0)
    if reach > FARTHEST:
        raise RefusalError(
            f"{whose}: the UV map {found.uv_map.name} has coordinates up to {reach:.3g}. Texels "
            f"have exact places only up to {FARTHEST:.0e}: move these corners to the others"
        )
    if faces_without_area(found) == len(found.face_sizes):
        raise RefusalError(f"{whose}: no face has an area on the UV map {found.uv_map.name}")


def faces_without_area(found: cage.Cage) -> int:
    """Counts the faces of the cage that are a line or a point on its UV map."""
    at = found.chosen_uv_map.values[found.chosen_uv_map.indices]
    starts = ragged_rows.starts(found.face_sizes)
    following = ragged_rows.following(found.face_sizes)
    around = at - np.repeat(at[starts], found.face_sizes, axis=0)
    cross = around[:, 0] * around[following, 1] - around[:, 1] * around[following, 0]
    return int((np.add.reduceat(cross, starts) == 0).sum())


def uv_data(surface: limitsurf.LimitSurface, found: cage.Cage, whose: str) -> limitsurf.SurfaceData:
    """Returns the cage's UV map on the limit surface, by the rules of its modifier."""
    check_uv_map(found, whose)
    return surface.face_varying(
        found.chosen_uv_map.values, found.chosen_uv_map.indices, found.rules.uv_interpolation
    )


def texels(
    uv_data: limitsurf.SurfaceData,
    size: tuple[int, int],
    tile: int = FIRST_TILE,
    *,
    margin: float = 0,
    allow_overlap: bool = False,
    progress: Progress | None = None,
) -> limitsurf.Texels:
    """Returns the texels of an image of so many texels across and up, for a UDIM tile. Maybe none
    of them lies inside an island: only the caller knows whether other tiles hold some. Then those
    that there are belong to the margin of islands in a tile beside this one, and must not be
    written. Raises RefusalError where the map overlaps itself by more than folds, unless that is
    allowed.
    """
    width, height = size
    found = uv_data.rasterize(
        width, height, tile=uv_tiles.corner(tile), margin=margin, progress=progress
    )
    if not allow_overlap:
        overlap.check(found, f" of tile {tile}" if tile != FIRST_TILE else "")
    return found


def told(name: str, count: int, *, is_mapped: bool = True) -> str:
    """Returns how many texels of an image were written. Where a UV map places them, those of the
    margin do not count.
    """
    where = " inside islands of the UV map" if is_mapped else ""
    return f"{name}: {counted(count, 'texels')}{where}"


def parts(count: int, progress: Progress) -> Iterator[slice]:
    """Yields `count` texels in parts, and reports the progress after each part."""
    return slices(count, PART, progress)


def check_size(width: int, height: int, tiles: int, images: int, allow_large: bool) -> None:
    """Raises TooLargeError where the images would take much memory, unless that is allowed."""
    pixels = width * height
    needed = pixels * BYTES_PER_TEXEL + pixels * tiles * images * BYTES_PER_PIXEL
    if needed > LARGE_MEMORY and not allow_large:
        tiled = f", {tiles} tiles" if tiles > 1 else ""
        raise TooLargeError(
            f"{counted(images, 'images')} of {width:,} x {height:,} pixels{tiled} "
            f"take {memory_text(needed)}: turn on Allow Large Images (allow_large) to make them"
        )


def _named(ob: bpy.types.Object, mesh: bpy.types.Mesh, name: str) -> uv_map.UvMap:
    if name not in ob.data.uv_layers and name not in mesh.uv_layers:
        raise RefusalError(f"{ob.name} has no UV map {name!r}")
    reason = uv_map.obstacle(mesh, name)
    if reason:
        raise RefusalError(f"{ob.name}: {reason}")
    return uv_map.read(mesh, name)
