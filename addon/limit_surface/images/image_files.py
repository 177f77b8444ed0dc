# SPDX-License-Identifier: GPL-3.0-or-later
"""Images as files, OpenEXR and PNG, through Blender's own image I/O.

Only the settings of a scene can choose the bit depth of a file, so a private scene is used. Its
view transform is Standard: data and float images are written to EXR files unchanged, and colors to
PNG files as the screen shows them.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError

#: Color spaces whose float values are written to files unchanged
UNCONVERTED = ("Non-Color", "Linear Rec.709", "Linear", "Raw", "Generic Data")


#: Options of properties that hold paths
PATH_OPTIONS = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (4, 5) else set()


@dataclass(frozen=True)
class FileKind:
    file_format: str
    depth: str  # bits for each channel
    suffix: str

    @property
    def is_float(self) -> bool:
        return self.file_format == "OPEN_EXR"


EXR_32 = FileKind("OPEN_EXR", "32", ".exr")
EXR_16 = FileKind("OPEN_EXR", "16", ".exr")
PNG_16 = FileKind("PNG", "16", ".png")
PNG_8 = FileKind("PNG", "8", ".png")
KINDS = {"EXR_32": EXR_32, "EXR_16": EXR_16, "PNG_16": PNG_16, "PNG_8": PNG_8}


#: The last chunk of every PNG file: no bytes of the kind IEND, and their checksum
_PNG_END = bytes(4) + b"IEND" + bytes.fromhex("ae426082")


def save_copy(image: bpy.types.Image, path: str | Path, kind: FileKind) -> None:
    """Saves a copy of the image, which itself does not change. Raises RefusalError where the file
    cannot be written.
    """
    path = Path(path)
    check_folder(path.parent)
    try:
        with _scene_that_saves(kind, image.colorspace_settings.name) as scene:
            image.save_render(str(path), scene=scene)
    except RuntimeError as error:
        # the first line has the reason; others repeat the path, and the name of a private image
        reason = str(error).strip().partition("\n")[0].removeprefix("Error: ")
        raise RefusalError(f"{path} cannot be written: {reason}") from error
    if kind.file_format == "PNG" and not _is_whole_png(path):
        raise RefusalError(f"{path} was not written completely: the disk may be full")


def _is_whole_png(path: Path) -> bool:
    """Tells whether a file has the end of a PNG file: Blender does not say where it could write
    only a part.
    """
    if not path.is_file():
        return False
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - len(_PNG_END)))
        return file.read() == _PNG_END


def save_pixels(pixels: np.ndarray, path: str | Path, kind: FileKind) -> None:
    """Saves pixels (height, width, 4) unchanged. PNG files hold values from 0 to 1."""
    height, width, _ = pixels.shape
    image = bpy.data.images.new(
        ids.TEMPORARY_IMAGE,
        width,
        height,
        alpha=True,
        float_buffer=kind.is_float or kind.depth == "16",
        is_data=True,
    )
    try:
        image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
        save_copy(image, path, kind)
    finally:
        bpy.data.images.remove(image)


@dataclass(frozen=True)
class GivenPath:
    """A path as users have given it: where the file is, and how the .blend file refers to it."""

    absolute: Path
    is_relative: bool = False  # to the .blend file, so that both can move together

    def __truediv__(self, name: str) -> GivenPath:
        return replace(self, absolute=self.absolute / name)

    @property
    def stored(self) -> str:
        """The path for the .blend file, which may have been saved elsewhere meanwhile."""
        return bpy.path.relpath(str(self.absolute)) if self.is_relative else str(self.absolute)


def given_path(text: str) -> GivenPath:
    """Raises RefusalError where the path is relative to the .blend file and that has not been
    saved.
    """
    is_relative = text.startswith("//")
    if is_relative and not bpy.data.filepath:
        raise RefusalError(
            f"{text} is relative to the .blend file, which has not been saved: save it first"
        )
    return GivenPath(Path(bpy.path.abspath(text)), is_relative)


def check_folder(folder: Path) -> None:
    if not folder.is_dir():
        raise RefusalError(f"There is no folder {folder}")


@contextmanager
def _scene_that_saves(kind: FileKind, colorspace: str) -> Iterator[bpy.types.Scene]:
    scene = bpy.data.scenes.new(ids.CAGE_SCENE)
    try:
        scene.display_settings.display_device = _first(
            scene.display_settings, "display_device", "sRGB"
        )
        wanted = "Raw" if colorspace in ("Non-Color", "Raw") else "Standard"
        scene.view_settings.view_transform = _first(scene.view_settings, "view_transform", wanted)
        settings = scene.render.image_settings
        if hasattr(settings, "media_type"):  # from Blender 5.0 on
            settings.media_type = "IMAGE"
        settings.file_format, settings.color_mode = kind.file_format, "RGBA"
        settings.color_depth = kind.depth
        settings.compression = 15
        yield scene
    finally:
        bpy.data.scenes.remove(scene)


def _first(settings: bpy.types.bpy_struct, name: str, wanted: str) -> str:
    """Returns the wanted choice where Blender's color configuration has it, else the current
    one.
    """
    with suppress(TypeError):
        setattr(settings, name, wanted)
    return getattr(settings, name)
