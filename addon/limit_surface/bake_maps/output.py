# SPDX-License-Identifier: GPL-3.0-or-later
"""The images and files that the maps are written into."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ..images import baked_images, image_names
from ..images.baked_images import Target
from ..images.image_files import FileKind, GivenPath
from .maps import KINDS


@dataclass(frozen=True)
class Output:
    name: str  # the beginning of the images' names; the name of the map follows
    kind: FileKind
    folder: GivenPath | None
    reuse: bool  # whether existing images of these names are written to
    tiles: tuple[int, ...]
    size: tuple[int, int]

    def check(self, maps: tuple[str, ...]) -> None:
        """Raises RefusalError for what could not be written after the bake."""
        for name in maps:
            self._target(name, self.tiles).check(self.tiles)

    def put(
        self, baked: dict[str, dict[int, np.ndarray]]
    ) -> tuple[list[bpy.types.Image], list[str]]:
        """Returns the images, and warnings about them. Moves the pixels out of `baked`."""
        tiles = {name: list(of) for name, of in baked.items()}
        targets = {name: self._target(name, of) for name, of in tiles.items()}
        warnings = [baked_images.packed_instead(target) for target in targets.values()]
        made = baked_images.put(targets, baked)
        warnings += [baked_images.kept_tiles(image, tiles[name]) for name, image in made.items()]
        return list(made.values()), list(filter(None, warnings))

    def _target(self, map_name: str, tiles: Collection[int]) -> Target:
        target = Target(
            name=image_names.with_ending(self.name, f" {KINDS[map_name].name}"),
            size=self.size,
            kind=self.kind,
            has_formats=True,
            path=None,
            has_alpha=True,
            reuse=self.reuse,
            option="Reuse Images",
        )
        return replace(target, path=self._path(target, tiles)) if self.folder else target

    def _path(self, target: Target, tiles: Collection[int]) -> GivenPath:
        assert self.folder is not None
        image = target.existing()
        is_tiled = baked_images.is_tiled(tiles) or (image and image.source == "TILED")
        middle = ".<UDIM>" if is_tiled else ""
        return self.folder / f"{image_names.file_stem(target.name)}{middle}{self.kind.suffix}"
