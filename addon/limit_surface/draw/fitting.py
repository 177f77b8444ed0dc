# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves that are fitted to strokes, as arrays in the space of the object that gets them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..placing.posed_surface import transformed
from ..placing.roots import Locations
from .ground import Ground
from .stroke import Stroke

#: By how much the radius between two control points may be off, as a share of the full radius
RADIUS_TOLERANCE = 0.02


@dataclass(frozen=True)
class Spline:
    locations: Locations
    position: np.ndarray  # (k, 3) float32
    handles: tuple[np.ndarray, np.ndarray] | None  # each (k, 3) float32; None for polylines
    radius: np.ndarray  # (k,) as a share of the full radius
    is_closed: bool
    resolution: int
    deviation: float  # world units: the largest distance from the surface, or from the offset
    material_index: int = 0
    use_smooth: bool = True


@dataclass(frozen=True)
class Fit:
    kind: str  # BEZIER, POLY
    tolerance: float  # world units
    offset: float  # world units

    def spline(self, stroke: Stroke, ground: Ground, matrix: np.ndarray) -> Spline:
        """Returns the curve in the space that the matrix maps to the world."""
        found = ground.surface.fit_path(
            stroke.face,
            stroke.uv,
            self.tolerance,
            kind="bezier" if self.kind == "BEZIER" else "poly",
            closed=stroke.is_closed,
            offset=self.offset * ground.outward,
            values=stroke.radius,
            value_tolerance=RADIUS_TOLERANCE,
        )
        count = len(found.rows) - stroke.is_closed  # a closed curve does not repeat its first point
        rows = found.rows[:count]
        uv = stroke.uv[rows].astype(np.float32)
        places = ground.posed.places(stroke.face[rows], uv.astype(np.float64), matrix)
        into = np.linalg.inv(matrix)
        shift = self.offset * stroke.normal[rows]
        # where the surface has no normal, that of the frame
        lost = ~np.isfinite(shift).all(axis=1)
        frames = ground.surface.frames(stroke.face[rows][lost], uv[lost].astype(np.float64))
        shift[lost] = self.offset * ground.outward * frames[:, :, 2]
        handles = None
        if found.handle_left is not None and found.handle_right is not None:
            left, right = found.handle_left[:count].copy(), found.handle_right[:count]
            if stroke.is_closed:
                left[0] = found.handle_left[-1]
            handles = (
                transformed(into, left).astype(np.float32),
                transformed(into, right).astype(np.float32),
            )
        return Spline(
            Locations(stroke.face[rows].astype(np.int32), uv),
            (places.position + shift @ into[:3, :3].T).astype(np.float32),
            handles,
            stroke.radius[rows],
            stroke.is_closed,
            found.resolution,
            found.deviation,
        )
