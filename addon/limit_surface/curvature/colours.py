# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature as colours: blue where it is negative, white where it is zero, red where it is
positive, and grey where there is none.

The steps are those of ColorBrewer's map RdBu (Cynthia Brewer), which prints well and the
colour-blind can read too, in the linear values that Blender's colour attributes hold.
"""

import numpy as np

from ..reading import srgb

AUTOMATIC = 95  # percentage of the values that are paler than the fullest colour

_STEPS = np.linspace(-1, 1, 11)
_SRGB = (
    (5, 48, 97), (33, 102, 172), (67, 147, 195), (146, 197, 222), (209, 229, 240), (247, 247, 247),
    (253, 219, 199), (244, 165, 130), (214, 96, 77), (178, 24, 43), (103, 0, 31),
)  # fmt: skip
_MISSING = 0.1


def full_of(values: np.ndarray) -> float:
    """Returns the absolute value that gets the fullest colour, where the user has not chosen
    one.
    """
    sizes = np.abs(values[np.isfinite(values)])
    return float(np.percentile(sizes, AUTOMATIC)) if len(sizes) else 0.0


def of_values(values: np.ndarray, full: float) -> np.ndarray:
    """Returns colours (n, 4) for values (n,). Values of `full` and more, positive or negative, get
    the fullest colour.
    """
    linear = srgb.to_linear(np.array(_SRGB) / 255)
    missing = ~np.isfinite(values)
    part = np.where(missing, 0, values) / full if full > 0 else np.zeros(len(values))
    rgb = np.stack([np.interp(part, _STEPS, channel) for channel in linear.T], axis=1)
    rgb[missing] = _MISSING
    return np.column_stack([rgb, np.ones(len(rgb))])
