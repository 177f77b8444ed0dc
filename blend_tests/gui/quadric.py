# SPDX-License-Identifier: GPL-3.0-or-later
"""The limit surface of the sheet in actions.py, known without any subdivision.

Control points on a quadric over the integers make a B-spline surface that is the same quadric,
raised by a sixth of its second derivatives; away from the boundary that is the limit surface. The
boundary curve is the spline of the boundary's vertices alone.
"""

import numpy as np

A, B, C = 0.06, -0.08, 0.03  # z = A x^2 + B y^2 + C x y


def height(x: float, y: float) -> float:
    return A * x * x + B * y * y + C * x * y + (A + B) / 3


def boundary_height(x: float) -> float:
    """Returns the height of the boundary along y = 0."""
    return A * x * x + A / 3


def normal(x: float, y: float) -> np.ndarray:
    upward = np.array([-2 * A * x - C * y, -2 * B * y - C * x, 1])
    return upward / np.linalg.norm(upward)


class Sheet:
    def __init__(self, matrix: list[list[float]]) -> None:
        self.matrix = np.array(matrix)
        self._inverse = np.linalg.inv(self.matrix)

    def local(self, point: np.ndarray) -> np.ndarray:
        return self._inverse[:3, :3] @ point + self._inverse[:3, 3]

    def world(self, point: np.ndarray) -> np.ndarray:
        return self.matrix[:3, :3] @ point + self.matrix[:3, 3]

    def world_normal(self, point: np.ndarray) -> np.ndarray:
        """Returns the normal in the world at a local point."""
        found = self._inverse[:3, :3].T @ normal(*point[:2])
        return found / np.linalg.norm(found)

    def above(self, point: np.ndarray) -> float:
        """Returns how far a world point is above the surface, along the sheet's own z."""
        x, y, z = self.local(point)
        return z - height(x, y)


class Camera:
    def __init__(self, corner: tuple, size: tuple, matrix: list[list[float]]) -> None:
        self._corner, self._size = np.array(corner), np.array(size)
        self._matrix = np.array(matrix)

    def pixel(self, point: np.ndarray) -> np.ndarray:
        """Returns the pixel of the window where a world point is seen."""
        x, y, _z, w = self._matrix @ [*point, 1]
        return self._corner + self._size * (np.array([x, y]) / w + 1) / 2
