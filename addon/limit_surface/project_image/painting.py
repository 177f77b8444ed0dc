# SPDX-License-Identifier: GPL-3.0-or-later
"""Painting of a source's colors over the pixels of a texture, part by part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..images import texel_places
from ..tasks.job import Progress
from .colours import Encoding
from .sources import Places, Source

if TYPE_CHECKING:
    import limitsurf


@dataclass
class Canvas:
    """A tile of the texture, changed in place."""

    pixels: np.ndarray  # (height, width, 4) float32, the image's own values
    encoding: Encoding

    @property
    def size(self) -> tuple[int, int]:
        """The width and the height."""
        return self.pixels.shape[1], self.pixels.shape[0]

    @property
    def texel(self) -> tuple[float, float]:
        return 1 / self.size[0], 1 / self.size[1]


class Painted(NamedTuple):
    texels: np.ndarray  # whether each of the texels was painted
    is_reached: bool  # whether the image falls on any texel inside islands, with any color


def paint(
    canvas: Canvas,
    texels: limitsurf.Texels,
    uv_map: limitsurf.SurfaceData,
    source: Source,
    opacity: float,
    progress: Progress,
) -> Painted:
    """Paints texels. All others keep their values to the last bit."""
    painted, is_reached = np.zeros(len(texels.face), bool), False
    whole = Places(uv_map, texels.face, texels.uv, canvas.texel)
    for rows in texel_places.parts(len(texels.face), progress):
        above, weight = source.look(whole.take(rows))
        weight = (opacity * weight).clip(0, 1)  # rounding may have given slightly more than 1
        taken = weight * above[:, 3] > 0
        at = texels.y[rows][taken], texels.x[rows][taken]
        below = canvas.pixels[at]
        canvas.pixels[at] = canvas.encoding.painted(below, above[taken], weight[taken])
        painted[rows] = taken
        is_reached |= bool((weight > 0)[texels.inside[rows]].any())
    return Painted(painted, is_reached)
