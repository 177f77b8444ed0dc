# SPDX-License-Identifier: Apache-2.0
"""Panels, words and the colour scale on one sheet."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from PIL import Image, ImageDraw

from figures.rendering.sheet import GREY, INK, colour_bar, font, save

#: Distances on the colour scale, in mean edges
LEAST, MOST, TICKS = 3e-4, 6e-2, (3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 6e-2)
#: Matplotlib's inferno, from almost white on
SCALE = LinearSegmentedColormap.from_list(
    "scale", [(0.96, 0.95, 0.92), *matplotlib.colormaps["inferno_r"](np.linspace(0.1, 0.74, 12))]
)
SMOOTH = 4  # times finer are lines drawn than they are shown
GAP, TOP, BOTTOM = 14, 40, 74


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
    widths, height = [p.width for p in pictures], pictures[0].height
    total = sum(widths) + GAP * (len(panels) + 1)
    sheet = Image.new("RGB", (total, TOP + height + BOTTOM), "white")
    draw = ImageDraw.Draw(sheet)
    mask = Image.new("L", (SMOOTH * sheet.width, SMOOTH * sheet.height))
    marks = ImageDraw.Draw(mask)
    left = GAP
    for panel, picture in zip(panels, pictures, strict=True):
        sheet.paste(picture, (left, TOP), picture)
        draw.text((left + picture.width / 2, 10), panel.title, INK, font(17), anchor="ma")
        if panel.circle:
            x, y, r = (picture.width * number for number in panel.circle)
            box = (left + x - r, TOP + y - r, left + x + r, TOP + y + r)
            marks.ellipse([SMOOTH * number for number in box], outline=255, width=2 * SMOOTH)
            for end in (-1, 1):
                line = _tangent(left + x, TOP + y, r, end, picture, left)
                marks.line([SMOOTH * number for number in line], fill=255, width=SMOOTH)
        left += picture.width + GAP
    sheet.paste(INK, (0, 0), mask.resize(sheet.size, Image.Resampling.BOX))
    _scale(sheet, draw, GAP + 20, TOP + height + 14, min(380, total // 3))
    at = max(GAP + widths[0] + GAP, 460)
    for i, note in enumerate(notes):
        draw.text((at, TOP + height + 10 + 20 * i), note, INK, font(14))
    save(_with_few_colours(sheet), output)


def _with_few_colours(sheet: Image.Image) -> Image.Image:
    """In 256 colours at most, a third of the size. The paper stays white."""
    palette = sheet.quantize(255, method=Image.Quantize.MEDIANCUT, kmeans=5)
    dithered = sheet.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
    pixels, colours = np.array(dithered), [*dithered.getpalette(), 255, 255, 255]
    pixels[(np.asarray(sheet) == 255).all(axis=2)] = len(colours) // 3 - 1
    small = Image.fromarray(pixels, mode="P")
    small.putpalette(colours)
    return small


def _tangent(
    x: float, y: float, r: float, end: int, picture: Image.Image, left: float
) -> tuple[float, ...]:
    """From a circle to a corner of the next picture: its upper left one, or (end = 1) lower."""
    corner = np.array([left + picture.width + GAP, TOP + picture.height * (end > 0)])
    towards = corner - (x, y)
    reach = np.hypot(*towards)
    turn = np.arctan2(towards[1], towards[0]) + end * np.arccos(r / reach)
    return x + r * np.cos(turn), y + r * np.sin(turn), *corner


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
