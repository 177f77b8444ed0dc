# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the viewport while somebody draws: the strokes and the brush."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ..viewport.lines import Colour, draw_line, pixel_size
from .stroke import Stroke

STROKE: Colour = (0.15, 0.85, 1.0, 1.0)
PEN: Colour = (1.0, 0.8, 0.1, 1.0)
BRUSHES: dict[str, Colour] = {
    "DRAW": (1.0, 1.0, 1.0, 0.9),
    "ERASE": (1.0, 0.3, 0.25, 0.9),
    "SMOOTH": (0.4, 0.9, 0.35, 0.9),
}
END: Colour = (1.0, 0.8, 0.1, 1.0)
WIDTH = 2.5  # pixels
#: Strokes are drawn so far before the surface, as a share of its size, that its polygons, which
#: are not quite where it is, do not hide them.
BEFORE = 2e-3
_TURN = np.linspace(0, 2 * np.pi, 33)


@dataclass(frozen=True)
class Mark:
    """The brush: a circle on the surface."""

    position: np.ndarray
    frame: np.ndarray  # (3, 3): columns across, across, normal
    pixels: float  # the circle's radius
    tool: str


class Overlay:
    """Draws into the 3D viewports of the window for which it was made, until it is removed."""

    def __init__(self, size: float) -> None:
        self.mark: Mark | None = None
        self.end: np.ndarray | None = None
        self.pen: list[np.ndarray] = []
        self.set_size(size)
        self._lines = np.empty((0, 3), np.float32)
        self._handler = bpy.types.SpaceView3D.draw_handler_add(
            self._draw, (), "WINDOW", "POST_VIEW"
        )

    def remove(self) -> None:
        bpy.types.SpaceView3D.draw_handler_remove(self._handler, "WINDOW")

    def set_size(self, size: float) -> None:
        """Is told the surface's extent."""
        self._before = BEFORE * size

    def show(self, strokes: list[Stroke]) -> None:
        shown = [
            np.repeat(stroke.position + self._before * np.nan_to_num(stroke.normal), 2, axis=0)[
                1:-1
            ]
            for stroke in strokes
        ]
        self._lines = np.concatenate([np.empty((0, 3)), *shown]).astype(np.float32)

    def _draw(self) -> None:
        region, view = bpy.context.region, bpy.context.region_data
        gpu.state.blend_set("ALPHA")
        try:
            gpu.state.depth_test_set("LESS_EQUAL")
            self._draw_strokes(region)
            gpu.state.depth_test_set("NONE")
            for points in self.pen:
                draw_line(region, points, PEN, WIDTH)
            if self.mark:
                self._draw_mark(region, np.array(view.perspective_matrix), self.mark)
        finally:
            gpu.state.depth_test_set("NONE")
            gpu.state.blend_set("NONE")

    def _draw_strokes(self, region: bpy.types.Region) -> None:
        if not len(self._lines):
            return
        shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
        shader.bind()
        shader.uniform_float("viewportSize", (region.width, region.height))
        shader.uniform_float("lineWidth", WIDTH)
        shader.uniform_float("color", STROKE)
        batch_for_shader(shader, "LINES", {"pos": self._lines}).draw(shader)

    def _draw_mark(self, region: bpy.types.Region, matrix: np.ndarray, mark: Mark) -> None:
        pixel = pixel_size(region, matrix, mark.position)
        ring = mark.frame[:, :2] @ np.stack([np.cos(_TURN), np.sin(_TURN)])
        circle = mark.position + mark.pixels * pixel * ring.T
        draw_line(region, circle, BRUSHES[mark.tool], WIDTH)
        if self.end is not None:
            draw_line(region, np.stack([mark.position, self.end]), END, WIDTH)
