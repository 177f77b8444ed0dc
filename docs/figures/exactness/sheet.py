# SPDX-License-Identifier: Apache-2.0
"""Panels, notes and the colour scale on one sheet."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from PIL import Image, ImageDraw

from figures.rendering.sheet import GREY, INK, colour_bar, font, row_of_panels, save

#: Distances on the colour scale, in mean edges
LEAST, MOST, TICKS = 3e-4, 6e-2, (3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 6e-2)
#: Matplotlib's inferno, from almost white on
SCALE = LinearSegmentedColormap.from_list(
    "scale", [(0.96, 0.95, 0.92), *matplotlib.colormaps["inferno_r"](np.linspace(0.1, 0.74, 12))]
)
SMOOTH = 4  # lines are drawn this many times larger than they are shown
GAP, BOTTOM = 14, 74


def shades(distances: np.ndarray) -> np.ndarray:
    """Colours (n, 3) of distances, as they are on screen, from 0 to 1."""
    place = np.log(np.maximum(distances, 1e-30) / LEAST) / np.log(MOST / LEAST)
    return SCALE(np.clip(place, 0, 1))[:, :3]


@dataclass(frozen=True)
class Panel:
    picture: Path
    title: str
    circle: tuple[float, float, float] | None = None  # x, y and radius, in widths of the panel


def compose(panels: Sequence[Panel], notes: Sequence[str], output: Path) -> None:
    """The panels in a row, each under its title; the scale below the first, notes to its right."""
    pictures = [Image.open(panel.picture) for panel in panels]
    row = row_of_panels(pictures, [panel.title for panel in panels], BOTTOM)
    sheet = row.sheet
    mask = Image.new("L", (SMOOTH * sheet.width, SMOOTH * sheet.height))
    marks = ImageDraw.Draw(mask)
    top = row.bottom - pictures[0].height
    for panel, picture, left in zip(panels, pictures, row.left, strict=True):
        if panel.circle:
            x, y, r = (picture.width * number for number in panel.circle)
            box = (left + x - r, top + y - r, left + x + r, top + y + r)
            marks.ellipse([SMOOTH * number for number in box], outline=255, width=2 * SMOOTH)
            right = np.array([left + picture.width + GAP, top])
            for end in (0, 1):
                corner = right + [0, end * picture.height]
                line = _tangent(np.array([left + x, top + y]), r, 2 * end - 1, corner)
                marks.line([SMOOTH * number for number in line], fill=255, width=SMOOTH)
    sheet.paste(INK, (0, 0), mask.resize(sheet.size, Image.Resampling.BOX))
    _scale(sheet, row.pen, GAP + 20, row.bottom + 14, min(380, sheet.width // 3))
    at = max(GAP + pictures[0].width + GAP, 460)
    for i, note in enumerate(notes):
        row.pen.text((at, row.bottom + 10 + 20 * i), note, INK, font(14))
    save(_with_few_colours(sheet), output)


def _with_few_colours(sheet: Image.Image) -> Image.Image:
    """At most 256 colours, which makes the file a third as large. The paper stays white."""
    palette = sheet.quantize(255, method=Image.Quantize.MEDIANCUT, kmeans=5)
    dithered = sheet.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
    pixels, colours = np.array(dithered), [*dithered.getpalette(), 255, 255, 255]
    pixels[(np.asarray(sheet) == 255).all(axis=2)] = len(colours) // 3 - 1
    small = Image.fromarray(pixels, mode="P")
    small.putpalette(colours)
    return small


def _tangent(middle: np.ndarray, r: float, side: int, corner: np.ndarray) -> tuple[float, ...]:
    """From a circle to a corner of the next picture, along the upper side or (1) the lower one."""
    towards = corner - middle
    reach = np.hypot(*towards)
    turn = np.arctan2(towards[1], towards[0]) + side * np.arccos(r / reach)
    return middle[0] + r * np.cos(turn), middle[1] + r * np.sin(turn), *corner


def _scale(sheet: Image.Image, draw: ImageDraw.ImageDraw, x: int, y: int, width: int) -> None:
    ramp = shades(LEAST * (MOST / LEAST) ** np.linspace(0, 1, width))
    sheet.paste(colour_bar(ramp), (x, y))
    draw.rectangle((x - 1, y - 1, x + width, y + 14), outline=GREY)
    for value in TICKS:
        tick = x + width * np.log(value / LEAST) / np.log(MOST / LEAST)
        draw.line((tick, y + 14, tick, y + 19), fill=GREY)
        draw.text((tick, y + 21), f"{100 * value:g} %", INK, font(13), anchor="ma")
    said = "distance from the limit surface, relative to an edge"
    draw.text((x + width / 2, y + 39), said, GREY, font(13), anchor="ma")
