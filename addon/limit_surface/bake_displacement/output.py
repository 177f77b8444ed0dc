# SPDX-License-Identifier: GPL-3.0-or-later
"""Output of the displacement: a new image or one that exists, and files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from ..errors import RefusalError
from ..images import image_files, image_pixels, reused_images
from ..images.image_files import EXR_32
from ..images.image_pixels import FIRST_TILE


@dataclass(frozen=True)
class Output:
    name: str
    path: Path | None
    reuse: bool  # whether an existing image of that name is written to
    tiles: tuple[int, ...]
    size: tuple[int, int]

    def check(self) -> None:
        """Raises RefusalError for what could not be written after the work."""
        if self.path:
            self._check_path(self.path)
        image = self._existing()
        if image:
            reused_images.check_fits(
                image, tiles=self.tiles, size=self.size, is_float=True, option="Reuse Image"
            )
            if self.path and image.source == "TILED":
                self._check_saves_all(image, self.path)

    def put(self, pixels: Mapping[int, np.ndarray]) -> bpy.types.Image:
        """Returns the image with these pixels. Where it cannot be saved, it is not made or changed,
        and RefusalError is raised.
        """
        image = self._existing()
        if image is None:
            return self._new(pixels)
        if self.path:
            image_pixels.save_tiles(pixels, self.path, EXR_32)
        image_pixels.write(image, pixels)
        if self.path:
            image_pixels.attach(image, self.path)
        return image

    def _existing(self) -> bpy.types.Image | None:
        return reused_images.find(self.name) if self.reuse else None

    def _check_path(self, path: Path) -> None:
        image_files.check_folder(path.parent)
        if path.suffix.lower() != EXR_32.suffix:
            raise RefusalError(
                f"{path.name} does not end in {EXR_32.suffix}: the image is saved as OpenEXR"
            )
        if len(self.tiles) > 1 and "<UDIM>" not in path.name:
            raise RefusalError(
                f"Each of the {len(self.tiles)} tiles is saved in its own file: {path.name} must "
                "contain <UDIM>, which is replaced by the number of the tile"
            )

    def _check_saves_all(self, image: bpy.types.Image, path: Path) -> None:
        """Raises RefusalError where the files would not hold all tiles of an existing image."""
        others = image_pixels.checked(image).tiles.keys() - set(self.tiles)
        if others or "<UDIM>" not in path.name:
            raise RefusalError(
                f"The existing image {image.name} has tiles that the file would not hold: save the "
                "image yourself, set another name, or turn Reuse Image off"
            )

    def _new(self, pixels: Mapping[int, np.ndarray]) -> bpy.types.Image:
        if pixels.keys() == {FIRST_TILE}:
            image = image_pixels.new(
                self.name, *self.size, is_float=True, is_data=True, alpha=False
            )
            image_pixels.write(image, pixels, is_new=True)
        else:
            image = image_pixels.new_tiled(self.name, pixels, is_float=True, is_data=True)
        if self.path:
            try:
                image_pixels.save(image, self.path, EXR_32)
            except RefusalError:
                bpy.data.images.remove(image)
                raise
        return image
