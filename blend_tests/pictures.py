# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that are drawn again, beside those of the documentation."""

from pathlib import Path

import numpy as np
from PIL import Image

BLOCK = 16  # pixels: noise of few samples and the edges of letters even out over so many


def differences(one: Path, other: Path) -> tuple[float, float]:
    """In the mean, and in the block that differs most; of 255, in the channel that does most."""
    a, b = (np.asarray(Image.open(path).convert("RGB"), np.float64) for path in (one, other))
    assert a.shape == b.shape
    height, width = (size // BLOCK * BLOCK for size in a.shape[:2])
    blocks = (a - b)[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3)
    apart = np.abs(blocks.mean(axis=(1, 3)))
    return float(apart.mean()), float(apart.max())
