# SPDX-License-Identifier: Apache-2.0
"""How far a picture that is drawn again differs from the documentation's: for the tests.

Both functions compare the pictures as a whole and in square blocks of pixels, so that an error in
one place is not lost in the mean.
"""

from pathlib import Path

import numpy as np
from PIL import Image


def of_plots(one: np.ndarray, other: np.ndarray, block: int) -> tuple[float, float]:
    """For pictures without noise, (height, width, channels): the mean difference of all pixels, and
    of those in the block that differs most."""
    error = np.abs(one - other).mean(axis=2)
    return float(error.mean()), float(block_means(error[..., None], block).max())


def of_renders(one: Path, other: Path, block: int = 16) -> tuple[float, float]:
    """For pictures with noise, which evens out within a block: the mean difference of the blocks'
    mean colours, and the largest one in any channel, both of 255."""
    a, b = (np.asarray(Image.open(path).convert("RGB"), np.float64) for path in (one, other))
    assert a.shape == b.shape
    apart = np.abs(block_means(a - b, block))
    return float(apart.mean()), float(apart.max())


def block_means(values: np.ndarray, block: int) -> np.ndarray:
    """Means over blocks of pixels; pixels beyond the last whole block are left out."""
    rows, columns = values.shape[0] // block, values.shape[1] // block
    whole = values[: rows * block, : columns * block]
    return whole.reshape(rows, block, columns, block, -1).mean(axis=(1, 3))
