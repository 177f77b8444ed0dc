# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels of images with and without UDIM tiles.

Blender gives scripts only the first tile of a tiled image. The others are read from their files, or
from what the image has packed, so a tiled image has to be saved or packed before its tiles can be
read. To change one, all its tiles are saved in a temporary folder and packed from there. The image
keeps its path, and the files at that path do not change.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np

from ..errors import RefusalError
from . import image_files, temporary_files

FIRST_TILE = 1001


def sizes(image: bpy.types.Image) -> dict[int, tuple[int, int]]:
    """Returns the sizes of those tiles of a tiled image that have pixels."""
    return {tile.number: tuple(tile.size) for tile in image.tiles if all(tile.size)}


def has_pixels(image: bpy.types.Image) -> bool:
    """Tells whether any tile of the image has pixels."""
    return bool(sizes(image)) if image.source == "TILED" else len(image.pixels) > 0


def without_pixels(image: bpy.types.Image) -> set[int]:
    """Returns the numbers of the tiles that have no pixels, mostly because their files are
    missing.
    """
    if image.source != "TILED":
        return set() if len(image.pixels) else {FIRST_TILE}
    return {tile.number for tile in image.tiles} - sizes(image).keys()


def check_readable(image: bpy.types.Image) -> None:
    """Raises RefusalError where the tiles of a tiled image cannot be read."""
    whose = f"The tiled image {image.name}"
    if image.is_dirty:
        raise RefusalError(f"{whose} has changes that are not saved: save it first")
    if not (image.packed_files or image.filepath):
        raise RefusalError(f"{whose} has no files yet: save it first")
    linear = image.colorspace_settings.name in image_files.UNCONVERTED
    if image.is_float and not linear:
        raise RefusalError(
            f"{whose} has float pixels in the color space {image.colorspace_settings.name}, which "
            "is not supported"
        )
    packed = {file.tile_number for file in image.packed_files}
    for number in sizes(image).keys() - packed:
        path = _path_of_tile(image, number)
        if not Path(path).is_file():
            raise RefusalError(f"{whose} shows tile {number} from {path}, which does not exist")


def read_all(image: bpy.types.Image) -> dict[int, np.ndarray]:
    """Returns the pixels (height, width, 4) of all tiles as float32, by the tiles' numbers."""
    if image.source != "TILED":
        return {FIRST_TILE: _pixels(image)}
    check_readable(image)
    found = {}
    for number in sizes(image):
        with _tile_file(image, number) as file:
            found[number] = _from_file(image, file)
    return found


def shown_from_files(
    image: bpy.types.Image, are_wanted: Callable[[Mapping[int, np.ndarray]], bool]
) -> bool:
    """Has the image show its files again, and returns true, if it has files that give the wanted
    pixels. An image with packed files is left as it is.
    """
    if image.source not in ("FILE", "TILED") or image.packed_files or not image.filepath_raw:
        return False
    tiles = [tile.number for tile in image.tiles] if image.source == "TILED" else [FIRST_TILE]
    try:
        found = {number: _from_file(image, _path_of_tile(image, number)) for number in tiles}
    except RefusalError:  # a file is missing, or cannot be read any more
        return False
    if not are_wanted(found):
        return False
    image.update_tag()
    image.reload()
    return True


def write_some(
    image: bpy.types.Image, tiles: Mapping[int, np.ndarray], blank_is_float: bool | None = None
) -> None:
    """Writes some tiles and leaves the others as they are. Nothing is stored for undo, which
    image_pixels.write does. An image without any pixels becomes one with float or 8-bit pixels, as
    `blank_is_float` says.
    """
    is_float = image.is_float
    if blank_is_float is not None and not has_pixels(image):
        is_float = blank_is_float
        if image.source != "TILED":
            _become_generated(image, tiles[FIRST_TILE], is_float)
    # without this, a viewport that has nothing else to draw would go on showing the old pixels
    image.update_tag()
    if image.source != "TILED":
        channels = _narrowed(tiles[FIRST_TILE], image.channels)
        image.pixels.foreach_set(np.ascontiguousarray(channels, np.float32).ravel())
        image.update()
        return
    # The old tiles are not read if none of them stays: their files may be gone.
    stay = sizes(image).keys() - tiles.keys()
    all_tiles = {**(read_all(image) if stay else {}), **tiles}
    path, colorspace = image.filepath_raw, image.colorspace_settings.name
    with _saved(image.name, all_tiles, is_float) as files:
        if image.packed_files:
            image.unpack(method="REMOVE")
        image.filepath = files
        image.reload()
        image.pack()
        image.colorspace_settings.name = colorspace
    image.filepath_raw = path
    image.update()


def new(
    name: str, tiles: Mapping[int, np.ndarray], *, is_float: bool, is_data: bool
) -> bpy.types.Image:
    """Makes a packed image of these tiles."""
    with _saved(name, tiles, is_float) as files:
        image = opened(files, min(tiles))
        if is_data:
            image.colorspace_settings.name = "Non-Color"
        elif not is_float:
            image.colorspace_settings.name = "sRGB"
        image.pack()
    image.name = name
    image.filepath_raw = ""
    return image


def opened(path: str, tile: int) -> bpy.types.Image:
    """Opens the tiled image of the files whose path has <UDIM> in place of a number; `tile` is one
    of its tiles.
    """
    image = bpy.data.images.load(path.replace("<UDIM>", str(tile)))
    image.source = "TILED"
    image.filepath = path
    return image


def _pixels(image: bpy.types.Image) -> np.ndarray:
    width, height = image.size
    flat = np.empty(len(image.pixels), np.float32)
    if not flat.size:
        raise RefusalError(f"The image {image.name} has no pixels: check that its file exists")
    image.pixels.foreach_get(flat)
    channels = flat.reshape(height, width, -1)
    if channels.shape[2] == 4:
        return channels
    wide = np.ones((height, width, 4), np.float32)
    wide[:, :, :3] = channels[:, :, : 1 if channels.shape[2] < 3 else 3]
    if channels.shape[2] == 2:
        wide[:, :, 3] = channels[:, :, 1]
    return wide


def _narrowed(pixels: np.ndarray, channels: int) -> np.ndarray:
    """Returns the channels that the file keeps: an image with one or two channels takes grey from
    the first, and alpha from the last one.
    """
    return pixels[:, :, [0, 3]] if channels == 2 else pixels[:, :, :channels]


def _become_generated(image: bpy.types.Image, pixels: np.ndarray, is_float: bool) -> None:
    """Makes an image whose file is missing one that can hold these pixels."""
    path = image.filepath_raw
    image.source = "GENERATED"
    image.filepath_raw = path  # Blender has dropped it
    image.generated_height, image.generated_width, _ = pixels.shape
    image.use_generated_float = is_float


def _path_of_tile(image: bpy.types.Image, number: int) -> str:
    path = bpy.path.abspath(image.filepath_raw, library=image.library)
    across, up = (number - FIRST_TILE) % 10 + 1, (number - FIRST_TILE) // 10 + 1
    return path.replace("<UDIM>", str(number)).replace("<UVTILE>", f"u{across}_v{up}")


@contextmanager
def _tile_file(image: bpy.types.Image, number: int) -> Iterator[str]:
    packed = [p for p in image.packed_files if p.tile_number == number]
    if not packed:
        yield _path_of_tile(image, number)
        return
    what = f"Tile {number} of {image.name}"
    with temporary_files.folder(what) as folder:
        file = folder / f"tile{Path(packed[0].filepath).suffix}"
        with temporary_files.written(what):
            file.write_bytes(packed[0].packed_file.data)
        yield str(file)


def _from_file(image: bpy.types.Image, path: str) -> np.ndarray:
    """Returns the pixels that the image would show from this file."""
    with _loaded(path) as tile:
        tile.colorspace_settings.name = image.colorspace_settings.name
        tile.alpha_mode = image.alpha_mode
        return _pixels(tile)


@contextmanager
def _loaded(path: str) -> Iterator[bpy.types.Image]:
    try:
        image = bpy.data.images.load(path)
    except RuntimeError as error:
        raise RefusalError(str(error).strip()) from error
    try:
        yield image
    finally:
        bpy.data.images.remove(image)


@contextmanager
def _saved(whose: str, tiles: Mapping[int, np.ndarray], is_float: bool) -> Iterator[str]:
    """Saves the tiles' numbers unchanged in files, and returns their common path, with <UDIM>."""
    kind = image_files.EXR_32 if is_float else image_files.PNG_8
    with temporary_files.folder(f"The tiles of {whose}") as folder:
        for number, pixels in tiles.items():
            image_files.save_pixels(pixels, f"{folder}/tile.{number}{kind.suffix}", kind)
        yield f"{folder}/tile.<UDIM>{kind.suffix}"
