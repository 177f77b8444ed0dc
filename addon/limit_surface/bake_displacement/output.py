# SPDX-License-Identifier: GPL-3.0-or-later
"""The image and the file that the displacement is written into."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from ..errors import RefusalError
from ..images import baked_images, image_files
from ..images.baked_images import Target
from ..images.image_files import EXR_32, GivenPath


@dataclass(frozen=True)
class Output:
    name: str
    path: GivenPath | None
    reuse: bool  # whether an existing image of that name is written to
    tiles: tuple[int, ...]
    size: tuple[int, int]

    def check(self) -> None:
        """Raises RefusalError for what could not be written after the work."""
        if self.path:
            self._check_path(self.path.absolute)
        self._target.check(self.tiles)

    def put(self, pixels: dict[int, np.ndarray]) -> tuple[bpy.types.Image, list[str]]:
        """Returns the image with these pixels, and warnings about it. Where it cannot be saved, it
        is not made or changed, and RefusalError is raised.
        """
        tiles, target = list(pixels), self._target
        packed = baked_images.packed_instead(target)
        image = baked_images.put({self.name: target}, {self.name: pixels})[self.name]
        return image, [packed, baked_images.kept_tiles(image, tiles)]

    @property
    def _target(self) -> Target:
        return Target(
            name=self.name,
            size=self.size,
            kind=EXR_32,
            has_formats=False,
            path=self.path,
            has_alpha=False,
            reuse=self.reuse,
            option="Reuse Image",
        )

    def _check_path(self, path: Path) -> None:
        image_files.check_folder(path.parent)
        if path.suffix.lower() != EXR_32.suffix:
            raise RefusalError(
                f"{path.name} does not end in {EXR_32.suffix}: the image is saved as OpenEXR"
            )
        if baked_images.is_tiled(self.tiles) and "<UDIM>" not in path.name:
            what = (
                f"Each of the {len(self.tiles)} tiles"
                if len(self.tiles) > 1
                else f"Tile {self.tiles[0]}"
            )
            raise RefusalError(
                f"{what} is saved in its own file: {path.name} must contain <UDIM>, which is "
                "replaced by the number of the tile"
            )
