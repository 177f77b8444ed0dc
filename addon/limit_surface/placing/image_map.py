# SPDX-License-Identifier: GPL-3.0-or-later
"""The pixels of an image as a function of (u, v)."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..errors import RefusalError
from .channels import pick


@dataclass(frozen=True)
class ImageMap:
    values: np.ndarray  # (height, width), the lowest row first
    extension: str  # REPEAT, EXTEND or CLIP

    def at(self, uv: np.ndarray) -> np.ndarray:
        """Returns values that are interpolated linearly between the four nearest pixels'
        centres.
        """
        height, width = self.values.shape
        inside = uv - np.floor(uv) if self.extension == "REPEAT" else uv.clip(0, 1)
        (x, along_x), (y, along_y) = (
            self._pixels(inside[:, axis], size) for axis, size in ((0, width), (1, height))
        )
        below, above = (
            self.values[row, x[0]] * (1 - along_x) + self.values[row, x[1]] * along_x for row in y
        )
        found = below * (1 - along_y) + above * along_y
        if self.extension == "CLIP":
            found[((uv < 0) | (uv > 1)).any(axis=1)] = 0
        return found

    def _pixels(
        self, coordinate: np.ndarray, size: int
    ) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray]:
        """Returns the two pixels between which a coordinate lies, and its place between them."""
        place = coordinate * size - 0.5
        first = np.floor(place).astype(np.int64)
        both = first, first + 1
        if self.extension == "REPEAT":
            return tuple(pixel % size for pixel in both), place - first
        return tuple(pixel.clip(0, size - 1) for pixel in both), place - first


def read(image: bpy.types.Image, channel: str, extension: str) -> ImageMap:
    """Reads the image. Raises RefusalError where there are no pixels to read, or some are not
    finite.
    """
    if image.source == "TILED":
        raise RefusalError(f"The image {image.name} is tiled (UDIM), which is not supported")
    pixels = np.empty(len(image.pixels), np.float32)  # `image.pixels` reads the file
    width, height = image.size
    if not pixels.size:
        raise RefusalError(f"The image {image.name} has no pixels: check that its file exists")
    image.pixels.foreach_get(pixels)
    values = pick(pixels.reshape(height, width, -1), channel, f"image {image.name}")
    return ImageMap(values, extension)
