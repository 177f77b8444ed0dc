# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that an earlier bake has made, and that the next one writes into."""

import os
from collections.abc import Collection
from pathlib import Path

import bpy

from ..errors import RefusalError
from . import image_pixels, image_tiles


def find(name: str) -> bpy.types.Image | None:
    """Returns the image of this name that the file itself holds, or None."""
    return bpy.data.images.get((name, None))


def check_fits(
    image: bpy.types.Image,
    *,
    tiles: Collection[int],
    size: tuple[int, int],
    is_float: bool,
    has_formats: bool,
    option: str,
) -> None:
    """Raises RefusalError where these tiles cannot be written into the image. `has_formats` tells
    whether users can choose another format, and `option` names the property that, turned off, has a
    new image made.
    """
    whose = f"The existing image {image.name}"
    otherwise = f"or another name, or turn {option} off"
    try:
        described = image_pixels.checked(image, to_write=True, replaced=tiles)
    except RefusalError as error:
        raise RefusalError(
            f"{error}. You can also set another name, or turn {option} off"
        ) from error
    blank = image_tiles.without_pixels(image)  # these take any pixels
    missing = set(tiles) - described.tiles.keys() - blank
    if missing:
        raise RefusalError(
            f"{whose} has no tile {min(missing)}: add the tile, set another name, or turn {option} "
            "off"
        )
    for tile in set(tiles) - blank:
        if described.tiles[tile] != size:
            width, height = described.tiles[tile]
            raise RefusalError(f"{whose} has {width} x {height} pixels: set this size {otherwise}")
    if described.tiles and described.is_float != is_float:
        depth = "float" if described.is_float else "8-bit"
        raise RefusalError(
            f"{whose} has {depth} pixels, which do not fit the {'chosen ' if has_formats else ''}"
            f"format: set another {'format or ' if has_formats else ''}name, or turn {option} off"
        )
    if not described.is_data:
        raise RefusalError(
            f"{whose} has the color space {described.colorspace}, but data need Non-Color: set "
            f"this color space {otherwise}"
        )


def check_saves_all(
    image: bpy.types.Image, tiles: Collection[int], path: Path, option: str
) -> None:
    """Raises RefusalError where the files at this path, into which these tiles are saved, would not
    hold all tiles of a tiled image. They hold the others if they are the image's own files.
    """
    if image.source != "TILED":
        return
    own = os.path.realpath(bpy.path.abspath(image.filepath_raw))
    are_own = not image.packed_files and own == os.path.realpath(path)
    others = image_tiles.sizes(image).keys() - set(tiles)
    if "<UDIM>" not in path.name or (others and not are_own):
        raise RefusalError(
            f"The existing image {image.name} has tiles that the file would not hold: save the "
            f"image yourself, set another name, or turn {option} off"
        )
