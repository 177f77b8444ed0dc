# SPDX-License-Identifier: Apache-2.0
"""The sheet on which panels, titles and colour scales are put together."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib import font_manager
from PIL import Image, ImageDraw, ImageFont

INK, GREY = (25, 25, 30), (95, 95, 105)


def font(size: int) -> ImageFont.FreeTypeFont:
    return ImageFont.truetype(font_manager.findfont("DejaVu Sans"), size)


class Row(NamedTuple):
    sheet: Image.Image
    pen: ImageDraw.ImageDraw
    left: list[int]  # of each panel
    middle: list[float]
    bottom: int  # of the panels


def row_of_panels(
    panels: Sequence[Image.Image],
    titles: Sequence[str],
    below: int,
    gap: int = 14,
    top: int = 40,
) -> Row:
    """The panels stand side by side on white paper, each under its title. All have one height, and
    `below` pixels under them stay free."""
    height = panels[0].height
    width = sum(panel.width + gap for panel in panels) + gap
    sheet = Image.new("RGB", (width, top + height + below), "white")
    pen = ImageDraw.Draw(sheet)
    row = Row(sheet, pen, [], [], top + height)
    left = gap
    for panel, title in zip(panels, titles, strict=True):
        sheet.paste(panel, (left, top), panel if panel.mode == "RGBA" else None)
        row.left.append(left)
        row.middle.append(left + panel.width / 2)
        pen.text((row.middle[-1], 10), title, INK, font(17), anchor="ma")
        left += panel.width + gap
    return row


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
