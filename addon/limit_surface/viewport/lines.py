# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines that are drawn over the 3D viewport."""

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

Colour = tuple[float, float, float, float]


def pixel_size(region: bpy.types.Region, matrix: np.ndarray, position: np.ndarray) -> float:
    """Returns the world length of a pixel at a position, by the view's perspective matrix."""
    w = matrix[3, :3] @ position + matrix[3, 3]
    return float(2 * abs(w) / (region.width * np.linalg.norm(matrix[0, :3])))


def draw_line(region: bpy.types.Region, points: np.ndarray, colour: Colour, width: float) -> None:
    """Draws a line through points (n, 3) of the world. The width is in pixels."""
    pos = np.ascontiguousarray(points, np.float32)
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", (region.width, region.height))
    shader.uniform_float("lineWidth", width)
    shader.uniform_float("color", colour)
    batch_for_shader(shader, "LINE_STRIP", {"pos": pos}).draw(shader)
