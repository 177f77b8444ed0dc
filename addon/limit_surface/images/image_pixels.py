# SPDX-License-Identifier: GPL-3.0-or-later
"""Images as arrays of pixels: reading them, and writing them so that it can be undone.

Pixels are (height, width, 4) float32, the lowest row first, just as Blender's buffers hold them:
- 8-bit images: in the image's own color space (mostly sRGB), 0 to 1, with straight alpha;
- float images, and 16-bit files: scene linear, with colors multiplied by alpha; images of color
  space Non-Color hold the numbers themselves.

Blender's undo restores everything about an image but its pixels, whatever the image's source. So
operators change an image only through `write`, and only in `finish`: it stores the pixels before
the change, and `pixel_undo` restores them. Undo does not change files that have been saved.

Tiles are identified by their UDIM numbers; 1001 is the square from (0, 0) to (1, 1) on the map. An
image without tiles counts as one tile 1001.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from ..errors import RefusalError
from . import failed_writes, image_files, image_tiles, pixel_undo
from .image_files import FileKind
from .image_tiles import FIRST_TILE

_WITHOUT_PIXELS = {
    "MOVIE": "is a movie",
    "SEQUENCE": "is an image sequence",
    "VIEWER": "is a render result or a viewer image",
}


@dataclass(frozen=True)
class Description:
    name: str
    width: int  # the size of the first tile
    height: int
    channels: int
    is_float: bool  # if true, pixels are scene linear and multiplied by alpha
    colorspace: str
    tiles: Mapping[int, tuple[int, int]]  # UDIM number -> width, height

    @property
    def is_data(self) -> bool:
        return self.colorspace in ("Non-Color", "Raw", "Generic Data")


def checked(
    image: bpy.types.Image | None, *, to_write: bool = False, replaced: Collection[int] = ()
) -> Description:
    """Describes an image, whose file is read for this. Raises RefusalError where there are no
    pixels, or they cannot be changed. An image without any pixels is accepted if its first tile is
    one of those that will be replaced; it is described as one without tiles.
    """
    if image is None:
        raise RefusalError("No image is chosen")
    whose = f"The image {image.name}"
    if image.source in _WITHOUT_PIXELS:
        raise RefusalError(f"{whose} {_WITHOUT_PIXELS[image.source]}, which is not supported")
    has_pixels = len(image.pixels) > 0  # reads the file, and only then Blender knows its layers
    if image.type == "MULTILAYER":
        raise RefusalError(f"{whose} has several layers, which is not supported")
    if to_write and not image.is_editable:
        raise RefusalError(f"{whose} is linked from another file and cannot be changed")
    if not has_pixels and not _may_be_made_anew(image, replaced):
        raise RefusalError(f"{whose} has no pixels: check that its file exists")
    tiles = {FIRST_TILE: tuple(image.size)} if has_pixels else {}
    if image.source == "TILED":
        if to_write:
            image_tiles.check_readable(image)  # what they showed is read, for undo
        tiles = image_tiles.sizes(image)
    width, height = next(iter(tiles.values()), (0, 0))
    return Description(
        image.name,
        width,
        height,
        image.channels,
        image.is_float,
        image.colorspace_settings.name,
        tiles,
    )


def _may_be_made_anew(image: bpy.types.Image, replaced: Collection[int]) -> bool:
    """Tells whether an image whose first tile has no pixels can be given pixels of any kind, as
    nothing else of it is kept.
    """
    return not image_tiles.has_pixels(image) and min(image_tiles.without_pixels(image)) in replaced


def read(image: bpy.types.Image, tile: int = FIRST_TILE) -> np.ndarray:
    """Returns pixels (height, width, 4) as float32. An image with one color channel gives grey;
    without an alpha channel alpha is 1.
    """
    if tile not in checked(image).tiles:
        raise RefusalError(f"The image {image.name} has no tile {tile}")
    return image_tiles.read_all(image)[tile]


def write(
    image: bpy.types.Image,
    pixels: np.ndarray | Mapping[int, np.ndarray],
    tile: int = FIRST_TILE,
    *,
    is_new: bool = False,
) -> None:
    """Writes the pixels of a whole tile, or of several tiles as a mapping from their numbers to
    their pixels. `is_new` means that the same operator has made the image, so that undo removes it;
    such an image is packed, too.

    The change takes part in undo and redo. Where the .blend file holds the image, packed or as a
    generated one, the new pixels are packed, and so are those of tiled images, because their files
    must not change without the user's knowledge. Other images are marked as changed, so that
    Blender asks to save them (`unsaved`).
    """
    given = pixels if isinstance(pixels, Mapping) else {tile: pixels}
    if is_new:
        _check_shapes(image, checked(image, to_write=True), given)
        # A generated image would lose its pixels at any change of its settings.
        image_tiles.write_some(image, given)
        image.pack()
    else:
        with written(image, given):
            pass


@contextmanager
def written(
    image: bpy.types.Image,
    pixels: Mapping[int, np.ndarray],
    *,
    blank_is_float: bool | None = None,
) -> Iterator[None]:
    """Writes the pixels of several tiles as `write` does, and takes the change back if an error
    follows within the `with` statement. So several images change together, or none does.

    `blank_is_float` allows an image without any pixels, for example because its file is missing,
    and tells which kind of pixels it gets. It is then packed, as there is no file.
    """
    may_be_blank = blank_is_float is not None
    described = checked(image, to_write=True, replaced=pixels.keys() if may_be_blank else ())
    _check_shapes(image, described, pixels)
    is_kept = _is_kept(image, described) or (not described.tiles and image.source != "TILED")
    with (
        failed_writes.packing_restored(image, is_kept),
        pixel_undo.recorded(image) as tell,
        failed_writes.settings_restored(image),
    ):
        if is_kept:
            _read_back_unchanged(image)
        image_tiles.write_some(image, pixels, blank_is_float)
        if described.is_float and described.channels == 4 and image.source != "TILED":
            tell(pixels)  # the image holds just these numbers
        else:
            tell(image_tiles.read_all(image))
        del pixels
        if is_kept:
            image.pack()
        yield


def _check_shapes(
    image: bpy.types.Image, described: Description, pixels: Mapping[int, np.ndarray]
) -> None:
    blank = image_tiles.without_pixels(image)
    for number, values in pixels.items():
        if number in blank:
            continue
        if number not in described.tiles:
            raise RefusalError(f"The image {image.name} has no tile {number}")
        width, height = described.tiles[number]
        if values.shape != (height, width, 4):
            raise ValueError(f"pixels have shape {values.shape}; expected ({height}, {width}, 4)")


def unsaved(image: bpy.types.Image) -> str:
    """Returns a warning if the pixels of an image are not saved with the .blend file."""
    if not image.is_dirty:
        return ""
    return (
        f"The .blend file does not store the changed pixels of {image.name}: save the image as well"
    )


def _is_kept(image: bpy.types.Image, described: Description) -> bool:
    """Tells whether the .blend file holds the image, and can store new pixels unchanged: Blender
    packs the buffer as it is, and converts it when it reads it. The tiles of tiled images are
    packed by `image_tiles`.
    """
    if image.source == "TILED" or not (image.source == "GENERATED" or image.packed_file):
        return False
    if described.is_float:
        return described.colorspace in image_files.UNCONVERTED
    return described.is_data or image.alpha_mode != "PREMUL"


def _read_back_unchanged(image: bpy.types.Image) -> None:
    """Has Blender take the colors of a packed float image for what its buffer holds. Where alpha is
    straight, it multiplies them by alpha once more whenever it reads them.
    """
    if image.is_float and image.alpha_mode == "STRAIGHT":
        image.alpha_mode = "PREMUL"


def new(
    name: str, width: int, height: int, *, is_float: bool, is_data: bool, alpha: bool = True
) -> bpy.types.Image:
    """Makes an image that is black, and transparent if it has alpha. It is saved with the .blend
    file, even if nothing uses it, like everything that operators make here.
    """
    image = bpy.data.images.new(
        name, width, height, alpha=alpha, float_buffer=is_float, is_data=is_data
    )
    image.generated_color = (0.0, 0.0, 0.0, 0.0 if alpha else 1.0)
    image.use_fake_user = True
    _read_back_unchanged(image)
    return image


def new_tiled(
    name: str,
    tiles: Mapping[int, np.ndarray],
    *,
    is_float: bool,
    is_data: bool,
) -> bpy.types.Image:
    """Makes a packed image of the given tiles."""
    image = image_tiles.new(name, tiles, is_float=is_float, is_data=is_data)
    image.use_fake_user = True
    return image


def save(image: bpy.types.Image, path: str | Path, kind: FileKind) -> None:
    """Saves the image to a file, or a tiled image to one file for each tile: <UDIM> in the path
    stands for the tile's number. From then on that is the image's file. Raises RefusalError where
    it cannot be written.
    """
    if image.source == "TILED":
        save_tiles(image_tiles.read_all(image), path, kind)
    else:
        image_files.save_copy(image, of_tile(path, FIRST_TILE), kind)
    attach(image, path)


def save_tiles(
    tiles: Mapping[int, np.ndarray],
    path: str | Path,
    kind: FileKind,
    written_at: Callable[[str], str | Path] = str,
) -> None:
    """Saves the pixels of each tile to its own file. `written_at` may have the file of a path
    written elsewhere.
    """
    for number, pixels in tiles.items():
        wanted = of_tile(path, number)
        there = str(written_at(wanted))
        try:
            image_files.save_pixels(pixels, there, kind)
        except RefusalError as error:
            raise RefusalError(str(error).replace(there, wanted)) from error


def attach(image: bpy.types.Image, path: str | Path) -> None:
    """Makes a file the image's own, with the image's color space. The path may begin with //, which
    is the folder of the .blend file. <UDIM> in the path stands for the tile of an image without
    tiles, too.
    """
    colorspace = image.colorspace_settings.name
    if image.packed_files:
        image.unpack(method="REMOVE")
    if image.source != "TILED":
        image.source = "FILE"
        path = of_tile(path, FIRST_TILE)
    image.filepath = str(path)
    image.reload()
    image.colorspace_settings.name = colorspace
    pixel_undo.record_rounded(image)


def of_tile(path: str | Path, tile: int) -> str:
    """Returns the path of a tile's file. <UDIM> in the path stands for the tile's number."""
    return str(path).replace("<UDIM>", str(tile))


def load(path: str | Path, tiles: list[int]) -> bpy.types.Image:
    """Loads an image from files that hold data; with <UDIM> in the path it is a tiled image. The
    path may begin with //, which is the folder of the .blend file.
    """
    if "<UDIM>" in str(path):
        image = image_tiles.opened(str(path), tiles[0])
    else:
        image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    image.use_fake_user = True
    return image
