# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that bakes make or write into, with their files: all of them change, or none does.

What an image showed before is read before any file changes, because a tiled image may show the very
files that are replaced.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from . import file_replacing, image_files, image_pixels, image_tiles, reused_images
from .image_files import FileKind, GivenPath
from .image_tiles import FIRST_TILE

MOST_NAMED = 5  # tiles that a warning names


@dataclass(frozen=True)
class Target:
    """Where the pixels of one image go."""

    name: str
    size: tuple[int, int]
    kind: FileKind
    has_formats: bool  # whether users can choose another kind
    path: GivenPath | None  # of its file, with <UDIM> where each tile has its own; None for no file
    has_alpha: bool
    reuse: bool  # whether an existing image of that name is written to
    option: str  # the property that, turned off, has a new image made

    @property
    def is_float(self) -> bool:
        """Tells whether the image has float pixels. In Blender those of 16 bits have, too."""
        return self.kind.depth != "8"

    def existing(self) -> bpy.types.Image | None:
        return reused_images.find(self.name) if self.reuse else None

    def check(self, tiles: Collection[int]) -> None:
        """Raises RefusalError for what could not be written after the work."""
        image = self.existing()
        if image:
            reused_images.check_fits(
                image,
                tiles=tiles,
                size=self.size,
                is_float=self.is_float,
                has_formats=self.has_formats,
                option=self.option,
            )
        if self.path:
            path = self.path.absolute
            image_files.check_folder(path.parent)
            for tile in tiles:
                file_replacing.check(image_pixels.of_tile(path, tile))
            if image:
                reused_images.check_saves_all(image, tiles, path, self.option)


def is_tiled(tiles: Collection[int]) -> bool:
    """Tells whether a new image of these tiles is a tiled one. A single tile 1001 is what an image
    without tiles shows.
    """
    return set(tiles) != {FIRST_TILE}


def put(
    targets: Mapping[str, Target], baked: dict[str, dict[int, np.ndarray]]
) -> dict[str, bpy.types.Image]:
    """Returns the images with the baked pixels, by the keys of both mappings. Raises RefusalError
    where one of them or its file cannot be written; then none of them has changed.

    Moves the pixels out of `baked`, so that they are not stored twice.
    """
    tiles = {key: list(of) for key, of in baked.items()}
    for key, target in targets.items():
        target.check(tiles[key])  # once more: users may have changed images during the work
    existing = {key: target.existing() for key, target in targets.items()}
    images: dict[str, bpy.types.Image] = {}
    with ExitStack() as all_or_none, file_replacing.all_or_none() as files:
        for key, target in targets.items():
            if target.path:
                at = target.path.absolute
                image_pixels.save_tiles(baked[key], at, target.kind, files.beside)
        for key, target in targets.items():
            pixels, image = baked.pop(key), existing[key]
            if image:
                written = image_pixels.written(image, pixels, blank_is_float=target.is_float)
                all_or_none.enter_context(written)
                images[key] = image
            elif not target.path:
                images[key] = all_or_none.enter_context(_made(target, pixels))
            del pixels
        files.place()
        for key, target in targets.items():
            if target.path and not existing[key]:
                loaded = _loaded(target, target.path.stored, tiles[key])
                images[key] = all_or_none.enter_context(loaded)
    for key, target in targets.items():
        if target.path and existing[key]:
            image_pixels.attach(images[key], target.path.stored)
    return {key: images[key] for key in targets}


def packed_instead(target: Target) -> str:
    """Returns a warning if the image that will be written to shows a missing file, and no other
    file is given, or none. Call it before the image is written.
    """
    image = target.existing()
    if image is None or target.path or image_tiles.has_pixels(image):
        return ""
    return (
        f"the file of {image.name} is missing or cannot be read, so the .blend file now holds the "
        "image"
    )


def kept_tiles(image: bpy.types.Image, baked: Collection[int]) -> str:
    """Returns a warning if the image shows tiles that were not baked now."""
    kept = sorted(image_tiles.sizes(image).keys() - set(baked)) if image.source == "TILED" else []
    if not kept:
        return ""
    named = ", ".join(str(tile) for tile in kept[:MOST_NAMED])
    if len(kept) > MOST_NAMED:
        named += f" and {len(kept) - MOST_NAMED:,} more"
    if len(kept) == 1:
        return f"tile {named} of {image.name} was not baked and shows what it showed before"
    return f"tiles {named} of {image.name} were not baked and show what they showed before"


@contextmanager
def _made(target: Target, pixels: Mapping[int, np.ndarray]) -> Iterator[bpy.types.Image]:
    """Makes an image that is packed in the .blend file, and removes it where an error follows."""
    if is_tiled(pixels):
        image = image_pixels.new_tiled(target.name, pixels, is_float=target.is_float, is_data=True)
    else:
        image = image_pixels.new(
            target.name,
            *target.size,
            is_float=target.is_float,
            is_data=True,
            alpha=target.has_alpha,
        )
    with _removed_on_error(image):
        if not is_tiled(pixels):
            image_pixels.write(image, pixels, is_new=True)
        del pixels
        yield image


@contextmanager
def _loaded(target: Target, path: str, tiles: list[int]) -> Iterator[bpy.types.Image]:
    if not is_tiled(tiles):
        path = image_pixels.of_tile(path, FIRST_TILE)
    with _removed_on_error(image_pixels.load(path, tiles)) as image:
        image.name = target.name
        yield image


@contextmanager
def _removed_on_error(image: bpy.types.Image) -> Iterator[bpy.types.Image]:
    try:
        yield image
    except BaseException:
        bpy.data.images.remove(image)
        raise
