# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances as colours: dark violet for zero, then blue, green, and yellow for the largest.

The steps are those of the map viridis, which the colour-blind can read too, in the linear values
that Blender's colour attributes hold.
"""

import numpy as np

from ..reading import srgb

_STEPS = np.linspace(0, 1, 9)
_SRGB = (
    (0.267, 0.005, 0.329), (0.279, 0.175, 0.483), (0.230, 0.322, 0.546), (0.173, 0.449, 0.558),
    (0.128, 0.567, 0.551), (0.158, 0.684, 0.502), (0.369, 0.789, 0.383), (0.678, 0.864, 0.190),
    (0.993, 0.906, 0.144),
)  # fmt: skip


def of_distances(distance: np.ndarray, full: float) -> np.ndarray:
    """Returns colours (n, 4) for distances (n,); those of `full` and more are yellow."""
    linear = srgb.to_linear(np.array(_SRGB))
    part = np.clip(distance / full, 0, 1) if full > 0 else np.zeros(len(distance))
    rgb = np.stack([np.interp(part, _STEPS, channel) for channel in linear.T], axis=1)
    return np.column_stack([rgb, np.ones(len(rgb))])
