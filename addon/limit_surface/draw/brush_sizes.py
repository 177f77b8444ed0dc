# SPDX-License-Identifier: GPL-3.0-or-later
"""The radii, in pixels, between which the keys [ and ] step."""

import numpy as np

LEAST, MOST, DEFAULT = 1, 1000, 25
STEP = 1.25  # from one radius to the next
#: The radii are whole numbers and all different, so that each step changes the brush, and both keys
#: go through the same ones, so that one takes back what the other has done. The default is among
#: them.
SIZES = np.unique(np.clip(np.round(DEFAULT * STEP ** np.arange(-14.0, 18.0)), LEAST, MOST))


def smaller(size: int) -> int:
    return int(SIZES[max(np.searchsorted(SIZES, size) - 1, 0)])


def larger(size: int) -> int:
    return int(SIZES[min(np.searchsorted(SIZES, size, "right"), len(SIZES) - 1)])
