# SPDX-License-Identifier: GPL-3.0-or-later
"""Output of baked pixels: new images, images that exist, and files.

Files are written first. If that fails, no image has changed, and files that did not exist before
are removed again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from ..images import image_files, image_names, image_pixels, reused_images
from ..images.image_files import FileKind
from .maps import KINDS


@dataclass(frozen=True)
class Output:
    name: str  # the beginning of the images' names; the name of the map follows
    kind: FileKind
    folder: Path | None
    reuse: bool  # whether existing images of these names are written to
    tiles: tuple[int, ...]
    size: tuple[int, int]

    def image_name(self, map_name: str) -> str:
        return image_names.with_ending(self.name, f" {KINDS[map_name].name}")

    def check(self, maps: tuple[str, ...]) -> None:
        """Raises RefusalError for what could not be written after the bake."""
        if self.folder:
            image_files.check_folder(self.folder)
        for name in maps:
            image = self._existing(name)
            if image:
                reused_images.check_fits(
                    image,
                    tiles=self.tiles,
                    size=self.size,
                    is_float=self._is_float,
                    option="Reuse Images",
                )

    def put(self, baked: dict[str, dict[int, np.ndarray]]) -> list[bpy.types.Image]:
        """Moves the pixels out of `baked`, so that they are not stored twice."""
        files = self._write_files(baked) if self.folder else {}
        made = []
        for name in list(baked):
            image, tiles = self._existing(name), baked.pop(name)
            path = files.get(name)
            if image:
                image_pixels.write(image, tiles)
                if path:
                    image_pixels.attach(image, path)
            elif path:
                image = image_pixels.load(path, list(tiles))
                image.name = self.image_name(name)
            else:
                image = self._new(self.image_name(name), tiles)
            made.append(image)
        return made

    def _existing(self, map_name: str) -> bpy.types.Image | None:
        return reused_images.find(self.image_name(map_name)) if self.reuse else None

    @property
    def _is_float(self) -> bool:
        """Tells whether the image has float pixels. In Blender those of 16 bits have, too."""
        return self.kind.depth != "8"

    def _new(self, name: str, tiles: Mapping[int, np.ndarray]) -> bpy.types.Image:
        if len(self.tiles) > 1:
            return image_pixels.new_tiled(name, tiles, is_float=self._is_float, is_data=True)
        image = image_pixels.new(name, *self.size, is_float=self._is_float, is_data=True)
        image_pixels.write(image, tiles, is_new=True)
        return image

    def _write_files(self, baked: Mapping[str, Mapping[int, np.ndarray]]) -> dict[str, Path]:
        files: dict[str, Path] = {}
        written: list[Path] = []
        assert self.folder is not None
        try:
            for name, tiles in baked.items():
                stem = image_names.file_stem(self.image_name(name))
                for number, pixels in tiles.items():
                    middle = f".{number}" if len(self.tiles) > 1 else ""
                    path = self.folder / f"{stem}{middle}{self.kind.suffix}"
                    if not path.exists():
                        written.append(path)
                    image_files.save_pixels(pixels, path, self.kind)
                middle = ".<UDIM>" if len(self.tiles) > 1 else ""
                files[name] = self.folder / f"{stem}{middle}{self.kind.suffix}"
        except BaseException:
            for path in written:
                path.unlink(missing_ok=True)
            raise
        return files
