# SPDX-License-Identifier: GPL-3.0-or-later
"""Laying what a source shows over the pixels of a texture, part by part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .. import native
from ..job import Progress
from .colours import Encoding
from .sources import Places, Source

if TYPE_CHECKING:
    import limitsurf

PART = 1 << 16  # texels at once: a progress bar moves, memory stays small


@dataclass
class Canvas:
    """A tile of the texture, changed in place."""

    pixels: np.ndarray  # (height, width, 4) float32, the image's own values
    encoding: Encoding

    @property
    def texel(self) -> tuple[float, float]:
        height, width, _ = self.pixels.shape
        return 1 / width, 1 / height


def paint(
    canvas: Canvas,
    texels: limitsurf.Texels,
    uv_map: limitsurf.SurfaceData,
    source: Source,
    opacity: float,
    progress: Progress,
) -> int:
    """How many texels have taken something. All others keep their values to the last bit."""
    count = 0
    whole = Places(uv_map, texels.face, texels.uv, canvas.texel)
    for begin in range(0, len(texels.face), PART):
        rows = slice(begin, begin + PART)
        above, weight = source.look(whole.take(rows))
        weight = opacity * weight
        taken = weight * above[:, 3] > 0
        at = texels.y[rows][taken], texels.x[rows][taken]
        below = canvas.encoding.decoded(canvas.pixels[at])
        mixed = native.limitsurf.blend_over(below, above[taken], weight[taken])
        canvas.pixels[at] = canvas.encoding.encoded(mixed)
        count += int(taken.sum())
        progress(min(begin + PART, len(texels.face)) / len(texels.face))
    return count
