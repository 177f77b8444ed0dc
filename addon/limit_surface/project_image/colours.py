# SPDX-License-Identifier: GPL-3.0-or-later
"""An image's values in the form that shaders read: linear light with separate alpha; and back.

Byte images hold what is in their file. Float images hold what shaders read, with the color
multiplied by alpha unless they are data or their alpha is a channel of its own. This was measured
in Blender, by rendering images that scripts have filled.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
from mathutils import Color

from .. import native
from ..errors import RefusalError
from ..reading import srgb

SRGB = "sRGB"
LINEAR = "Linear Rec.709"  # the primaries of sRGB, without its curve

SMALLEST_ALPHA = 1e-30  # below this alpha a multiplied color is not divided: it would overflow
UNCHANGED = 1e-5  # of primaries: Blender's single precision leaves this error

# texels of float images may hold infinity, or the largest number
_quietly = partial(np.errstate, over="ignore", invalid="ignore")


@dataclass(frozen=True)
class Encoding:
    is_curved: bool  # whether sRGB's curve is applied
    primaries: np.ndarray | None  # (3, 3) from Rec. 709 to the scene's; None where they are equal
    is_multiplied: bool  # whether colors are multiplied by alpha
    alpha_covers: bool  # otherwise alpha is unused, or data of its own

    def decoded(self, values: np.ndarray) -> np.ndarray:
        """Converts the image's own values (..., 4), float32, to what shaders read. Alpha is how
        much the color covers.
        """
        out = np.array(values, np.float32)
        if self.is_curved:
            out[..., :3] = srgb.to_linear(out[..., :3])
        if self.primaries is not None:
            out[..., :3] = out[..., :3] @ self.primaries.T
        if self.is_multiplied:
            alpha = out[..., 3:]
            with _quietly():
                out[..., :3] /= np.where(alpha > SMALLEST_ALPHA, alpha, 1)
        if not self.alpha_covers:
            out[..., 3] = 1
        return out

    def painted(self, values: np.ndarray, colors: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Returns the image's own values (n, 4) after these colors were laid over them. Alpha stays
        as it is where it does not tell how much the color covers.
        """
        mixed = self.encoded(native.limitsurf.blend_over(self.decoded(values), colors, weight))
        if not self.alpha_covers:
            mixed[..., 3] = values[..., 3]
        return mixed

    def encoded(self, values: np.ndarray) -> np.ndarray:
        """Converts what shaders read to the image's own values."""
        out = np.array(values, np.float32)
        if self.is_multiplied:
            with _quietly():
                out[..., :3] *= out[..., 3:]
        if self.primaries is not None:
            out[..., :3] = out[..., :3] @ np.linalg.inv(self.primaries).T
        if self.is_curved:
            out[..., :3] = srgb.from_linear(out[..., :3])
        return out


def alpha_covers(image: bpy.types.Image) -> bool:
    """Tells whether the image's alpha is how much its colors cover. Otherwise it is not used, or
    channel-packed: data that have nothing to do with the colors.
    """
    return image.alpha_mode not in {"NONE", "CHANNEL_PACKED"}


def of(image: bpy.types.Image) -> Encoding:
    """Returns the encoding of an image. Raises RefusalError where a byte image has a color space
    that only Blender itself can convert.
    """
    space, covers = image.colorspace_settings, alpha_covers(image)
    if image.is_float:
        return Encoding(False, None, covers and not space.is_data, covers)
    if space.is_data:
        return Encoding(False, None, False, covers)
    if space.name not in {SRGB, LINEAR}:
        raise RefusalError(
            f"The 8-bit image {image.name} has the color space {space.name}: 8-bit images can be "
            f"projected or painted on only if their color space is {SRGB}, {LINEAR} or Non-Color"
        )
    return Encoding(space.name == SRGB, _primaries(), False, covers)


def of_new(is_float: bool) -> Encoding:
    """Returns the encoding of an image for colors that Blender makes."""
    if is_float:
        return Encoding(False, None, True, True)
    return Encoding(True, _primaries(), False, True)


def _primaries() -> np.ndarray | None:
    """Returns the primaries of the scene's linear space, as Blender is configured."""
    columns = [Color(c).from_srgb_to_scene_linear() for c in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    found = np.array(columns, np.float32).T
    return None if np.abs(found - np.eye(3)).max() < UNCHANGED else found
