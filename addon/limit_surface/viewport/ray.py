# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of sight through a pixel of the viewport."""

from dataclasses import dataclass

import bpy
import numpy as np
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d

from ..placing.rotations import unit


@dataclass(frozen=True)
class Ray:
    origin: np.ndarray  # (3,) world
    direction: np.ndarray  # (3,) unit vector
    is_perspective: bool

    def apart(self, points: np.ndarray) -> np.ndarray:
        """Returns how far points (..., 3) are from the ray as seen on screen, up to a common
        factor; infinite behind the viewer.
        """
        arm = points - self.origin
        along = arm @ self.direction
        across = np.linalg.norm(arm - along[..., None] * self.direction, axis=-1)
        if not self.is_perspective:
            return across
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(along > 0, across / along, np.inf)

    def towards(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns origins, unit directions and lengths of the lines of sight to points (n, 3)."""
        if self.is_perspective:
            origins = np.broadcast_to(self.origin, points.shape)
        else:
            origins = points - ((points - self.origin) @ self.direction)[:, None] * self.direction
        arms = points - origins
        lengths = np.linalg.norm(arms, axis=1)
        return origins, arms / lengths[:, None], lengths


def through(region: bpy.types.Region, view: bpy.types.RegionView3D, x: int, y: int) -> Ray:
    """Returns the ray through the pixel (x, y), in the window's coordinates."""
    at = (x - region.x, y - region.y)
    return Ray(
        np.array(region_2d_to_origin_3d(region, view, at), np.float64),
        unit(np.array(region_2d_to_vector_3d(region, view, at), np.float64)),
        view.is_perspective,
    )
