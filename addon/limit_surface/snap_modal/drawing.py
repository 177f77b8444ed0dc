# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing in the viewport: the place, its normal, principal directions and border."""

from dataclasses import dataclass

import bpy
import gpu
import numpy as np

from ..viewport.lines import draw_line, pixel_size

NORMAL = (0.25, 0.55, 1.0, 1.0)
DIRECTIONS = ((1.0, 0.45, 0.1, 1.0), (0.2, 0.85, 0.35, 1.0))
RING = (1.0, 1.0, 1.0, 0.9)
LINE_WIDTH = 2.5  # pixels
LENGTH, RADIUS = 70, 9  # pixels
_TURN = np.linspace(0, 2 * np.pi, 33)


@dataclass(frozen=True)
class Mark:
    """The positions and unit vectors to draw, in the world."""

    position: np.ndarray
    frame: np.ndarray  # (3, 3): columns across, across, normal
    normal: np.ndarray | None
    directions: tuple[np.ndarray, ...]


class Drawing:
    """Draws into the 3D viewports of the window for which it was made, until it is removed."""

    def __init__(self) -> None:
        self.mark: Mark | None = None
        self._handler = bpy.types.SpaceView3D.draw_handler_add(
            self._draw, (), "WINDOW", "POST_VIEW"
        )

    def remove(self) -> None:
        bpy.types.SpaceView3D.draw_handler_remove(self._handler, "WINDOW")

    def _draw(self) -> None:
        mark = self.mark
        if mark is None:
            return
        region, view = bpy.context.region, bpy.context.region_data
        pixel = pixel_size(region, np.array(view.perspective_matrix), mark.position)
        ring = mark.frame[:, :2] @ np.stack([np.cos(_TURN), np.sin(_TURN)])
        gpu.state.blend_set("ALPHA")
        gpu.state.depth_test_set("NONE")
        try:
            draw_line(region, mark.position + RADIUS * pixel * ring.T, RING, LINE_WIDTH)
            for direction, colour in zip(mark.directions, DIRECTIONS, strict=False):
                arm = LENGTH * pixel * direction
                ends = np.stack([mark.position - arm, mark.position + arm])
                draw_line(region, ends, colour, LINE_WIDTH)
            if mark.normal is not None:
                tip = mark.position + LENGTH * pixel * mark.normal
                draw_line(region, np.stack([mark.position, tip]), NORMAL, LINE_WIDTH)
        finally:
            gpu.state.blend_set("NONE")
