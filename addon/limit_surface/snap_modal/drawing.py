# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing in the viewport: the place, its normal, principal directions and border."""

from dataclasses import dataclass

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

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
        pixel = _pixel_size(region, np.array(view.perspective_matrix), mark.position)
        ring = mark.frame[:, :2] @ np.stack([np.cos(_TURN), np.sin(_TURN)])
        gpu.state.blend_set("ALPHA")
        gpu.state.depth_test_set("NONE")
        try:
            _line(region, mark.position + RADIUS * pixel * ring.T, RING)
            for direction, colour in zip(mark.directions, DIRECTIONS, strict=False):
                arm = LENGTH * pixel * direction
                _line(region, np.stack([mark.position - arm, mark.position + arm]), colour)
            if mark.normal is not None:
                tip = mark.position + LENGTH * pixel * mark.normal
                _line(region, np.stack([mark.position, tip]), NORMAL)
        finally:
            gpu.state.blend_set("NONE")


def _pixel_size(region: bpy.types.Region, matrix: np.ndarray, position: np.ndarray) -> float:
    """Returns the world length of a pixel at a position."""
    w = matrix[3, :3] @ position + matrix[3, 3]
    return 2 * abs(w) / (region.width * np.linalg.norm(matrix[0, :3]))


def _line(
    region: bpy.types.Region, points: np.ndarray, colour: tuple[float, float, float, float]
) -> None:
    pos = np.ascontiguousarray(points, np.float32)
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", (region.width, region.height))
    shader.uniform_float("lineWidth", LINE_WIDTH)
    shader.uniform_float("color", colour)
    batch_for_shader(shader, "LINE_STRIP", {"pos": pos}).draw(shader)
