# SPDX-License-Identifier: Apache-2.0
"""The sheet on which panels, titles and colour scales are put together."""

from pathlib import Path

import numpy as np
from matplotlib import font_manager
from PIL import Image, ImageFont

INK, GREY = (25, 25, 30), (95, 95, 105)


def font(size: int) -> ImageFont.FreeTypeFont:
    return ImageFont.truetype(font_manager.findfont("DejaVu Sans"), size)


def on_screen(light: np.ndarray) -> np.ndarray:
    """From amounts of light to the screen's sRGB."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def light(colours: np.ndarray) -> np.ndarray:
    """From the screen's sRGB to amounts of light."""
    return np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)


def colour_bar(colours: np.ndarray, height: int = 14) -> Image.Image:
    """A bar of colours (n, 3), given as they are on screen, one for each column of pixels."""
    return Image.fromarray(np.tile(np.uint8(np.rint(255 * colours)), (height, 1, 1)))


def save(picture: Image.Image, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    picture.save(path, optimize=True)
    print(f"{path}: {path.stat().st_size >> 10} KiB", flush=True)
