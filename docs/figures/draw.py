# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of docs/draw.md: what view3d.limit_draw makes of strokes on a bent sheet."""

from pathlib import Path

import bpy
import numpy as np

from figures.rendering import scene
from figures.rendering.scene import View
from figures.snap import SIDE, add_cage, add_limit

PIXELS = (900, 560)
VIEW, MIDDLE, WIDTH = View(24, 40), np.array([0, 0, 0.1]), 3.9
CABLE, SEAM, STITCHES = (0.75, 0.17, 0.06), (0.02, 0.03, 0.05), (0.95, 0.8, 0.35)
SEAM_ROWS = 33
STITCH_COUNT, STITCH = 26, 0.07


def make(folder: Path, samples: int = 24) -> None:
    scene.start()
    cage = add_cage()
    t = np.linspace(0.06, 0.94, SEAM_ROWS)
    seam = np.stack([t, 0.32 + 0.12 * np.sin(7 * t)], axis=1)
    draw(cage, [seam], SEAM, radius=0.012)
    draw(cage, stitches(seam), STITCHES, radius=0.011, offset=0.008)
    cable = np.stack([t, 0.72 + 0.13 * np.sin(9 * t + 1)], axis=1)
    draw(cage, [cable], CABLE, radius=0.04, offset=0.04)
    turn = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.array([0.82, 0.42]) + 0.09 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    draw(cage, [ring], CABLE, radius=0.015, is_closed=True)
    cage.hide_render = True
    add_limit(cage)
    scene.render(folder / "draw.png", VIEW, MIDDLE, WIDTH, PIXELS, samples)


def stitches(seam: np.ndarray) -> list[np.ndarray]:
    """Short strokes across a line, at even places of it."""
    at = np.linspace(0.5, SEAM_ROWS - 1.5, STITCH_COUNT)
    row = at.astype(int)
    middle = seam[row] + (at - row)[:, None] * (seam[row + 1] - seam[row])
    along = seam[row + 1] - seam[row]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    across *= STITCH / 2 / np.linalg.norm(across, axis=1, keepdims=True)
    return [np.stack([m - a, m + a]) for m, a in zip(middle, across, strict=True)]


def draw(
    cage: bpy.types.Object,
    strokes: list[np.ndarray],
    colour: tuple[float, float, float],
    is_closed: bool = False,
    **properties: float,
) -> None:
    """Draws strokes through places (n, 2) of the whole sheet, each between 0 and 1."""
    bpy.context.view_layer.objects.active = cage
    bpy.ops.view3d.limit_draw(
        strokes=[
            point(place, i == 0, is_closed) for places in strokes for i, place in enumerate(places)
        ],
        tolerance=0.001,
        **properties,
    )
    made = bpy.context.active_object
    made.data.materials.append(scene.material(f"Drawn {made.name}", colour, 0.1))


def point(place: np.ndarray, is_first: bool, is_closed: bool) -> dict[str, object]:
    column, row = np.minimum((SIDE * place).astype(int), SIDE - 1)
    uv = SIDE * place - (column, row)
    return {
        "name": "",
        "face": int(column + SIDE * row),
        "uv": uv.tolist(),
        "radius": 1.0,
        "is_first": is_first,
        "is_closed": is_closed,
    }
