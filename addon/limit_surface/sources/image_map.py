# SPDX-License-Identifier: GPL-3.0-or-later
"""The pixels of an image as a function of (u, v)."""

from __future__ import annotations

from typing import Literal

import bpy
import numpy as np

from .. import native
from ..errors import RefusalError

# what the library does beyond the borders; outside of a clipped image the values are 0
_BEYOND: dict[str, Literal["extend", "repeat"]] = {
    "REPEAT": "repeat",
    "EXTEND": "extend",
    "CLIP": "extend",
}


class ImageMap:
    def __init__(self, values: np.ndarray, extension: str) -> None:
        """`values` (height, width) or (height, width, channels), the lowest row first; `extension`
        is REPEAT, EXTEND or CLIP.
        """
        self.values, self.extension = values, extension
        pixels = values.reshape(*values.shape[:2], -1)
        self._image = native.limitsurf.FilteredImage(pixels, _BEYOND[extension])

    def at(self, uv: np.ndarray) -> np.ndarray:
        """Returns values that are interpolated linearly between the four nearest pixels' centres:
        (n,) or (n, channels).
        """
        footprint = np.zeros((len(uv), 2, 2))  # of a place, not of an area
        found = self._image.sample(uv, footprint).astype(np.float64)
        if self.extension == "CLIP":
            found[((uv < 0) | (uv > 1)).any(axis=1)] = 0
        return found[:, 0] if self.values.ndim == 2 else found

    def bounds(self, boxes: np.ndarray) -> np.ndarray:
        """Returns numbers below and above what at() returns in boxes (n, 2, 2), each a lower and an
        upper corner: (n, 2), for an image of one channel.
        """
        found = self._image.bounds(boxes).astype(np.float64)[:, :, 0]
        if self.extension == "CLIP":
            beyond = (boxes[:, 0] < 0).any(axis=1) | (boxes[:, 1] > 1).any(axis=1)
            found[beyond, 0] = found[beyond, 0].clip(max=0)
            found[beyond, 1] = found[beyond, 1].clip(min=0)
        return found


def find(name: str) -> bpy.types.Image:
    """Returns the image of that name. Raises RefusalError where there is none."""
    if not name:
        if not bpy.data.images:
            raise RefusalError("The file has no image: open one in an Image Editor")
        raise RefusalError("Choose an image")
    image = bpy.data.images.get(name)
    if image is None:
        raise RefusalError(f"There is no image {name!r}")
    return image


def pixels(image: bpy.types.Image) -> np.ndarray:
    """Returns the pixels (height, width, channels). Raises RefusalError where there are none."""
    if image.source == "TILED":
        raise RefusalError(f"The image {image.name} is tiled (UDIM), which is not supported")
    values = np.empty(len(image.pixels), np.float32)  # `image.pixels` reads the file
    width, height = image.size
    if not values.size:
        raise RefusalError(f"The image {image.name} has no pixels: check that its file exists")
    image.pixels.foreach_get(values)
    return values.reshape(height, width, -1)
