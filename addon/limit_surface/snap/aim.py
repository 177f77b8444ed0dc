# SPDX-License-Identifier: GPL-3.0-or-later
"""The points of the target's surface where elements are put: the closest one, or the first along a
line.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..placing.rotations import unit
from ..tasks.job import part_of
from .surface import TargetSurface

WAYS = {"BOTH": (1.0, -1.0), "POSITIVE": (1.0,), "NEGATIVE": (-1.0,)}

# As a share of the largest coordinate: an element closer to the surface than this counts as lying
# on it, because Blender's single precision allows no more. At a border, its line might miss the
# surface or meet another part of it.
ON_SURFACE = 1e-6


@dataclass(frozen=True)
class Elements:
    """The elements that are to be snapped, in world space."""

    points: np.ndarray  # (n, 3)
    find_normals: Callable[[], np.ndarray]  # not every search needs them
    axes: np.ndarray  # (3, 3), or (n, 3, 3): columns are the local X, Y and Z as unit vectors
    # reason -> number of elements that cannot be snapped
    left_out: Counter[str] = field(default_factory=Counter)

    @cached_property
    def normals(self) -> np.ndarray:
        """The elements' own normals (n, 3), unit vectors; NaN where an element has none."""
        return self.find_normals()


@dataclass(frozen=True)
class View:
    """The view of the 3D viewport."""

    axes: np.ndarray  # (3, 3) columns X, Y, Z, the last one towards the viewer
    eye: np.ndarray | None  # the eye of a perspective view


@dataclass(frozen=True)
class Placement:
    rows: np.ndarray  # (k,) the elements that have a place
    face: np.ndarray  # (k,)
    uv: np.ndarray  # (k, 2)
    position: np.ndarray  # (k, 3) world, offset included
    surface: TargetSurface
    failures: Counter[str]  # reason -> number of elements

    @cached_property
    def frame(self) -> np.ndarray:
        """The frames (k, 3, 3) in the world, which points that have no rotation do not need."""
        return self.surface.places(self.face, self.uv, np.eye(4)).frame


@dataclass(frozen=True)
class Aim:
    mode: str  # NEAREST, AXIS, NORMAL
    axis: int
    orientation: str  # GLOBAL, LOCAL, VIEW
    direction: str  # BOTH, POSITIVE, NEGATIVE
    max_distance: float  # in world units
    max_angle: float | None  # the largest angle between an element's own normal and the surface's
    offset: float
    view: View | None

    def read(self, elements: Elements) -> None:
        """Reads from Blender's data what `place` needs, which may then run in another thread."""
        if self._needs_normals:
            _ = elements.normals

    def place(
        self,
        surface: TargetSurface,
        elements: Elements,
        single_precision: bool,
        progress: Callable[[float], None],
    ) -> Placement:
        """Finds the places. With `single_precision`, (u, v) will be stored so, and is rounded
        before it is evaluated.
        """
        finite = np.isfinite(elements.points).all(axis=1)
        directions = self._directions(elements)
        directed = np.isfinite(directions).all(axis=1)
        usable = np.flatnonzero(finite & directed)
        search = self._closest if self.mode == "NEAREST" else self._on_lines
        face, uv = search(surface, elements.points[usable], directions[usable], progress)
        hit = face >= 0
        face, uv = face[hit], uv[hit]
        if single_precision:
            uv = uv.astype(np.float32).astype(np.float64)
        if self.offset:
            position, frame = surface.places(face, uv, np.eye(4))
            position = position + self.offset * frame[:, :, 2]
        else:
            position = surface.positions(face, uv, np.eye(4))
        return Placement(
            rows=usable[hit],
            face=face,
            uv=uv,
            position=position,
            surface=surface,
            failures=elements.left_out
            + Counter(
                {
                    "the coordinates are not finite numbers": np.count_nonzero(~finite),
                    "there is no normal or axis that gives the direction of the search": (
                        np.count_nonzero(finite & ~directed)
                    ),
                    self._missed(): np.count_nonzero(~hit),
                }
            ),
        )

    @property
    def _needs_normals(self) -> bool:
        return self.mode == "NORMAL" or (self.mode == "NEAREST" and self.max_angle is not None)

    def _directions(self, elements: Elements) -> np.ndarray:
        """Returns the unit vectors (n, 3) of the search; NaN where an element has none."""
        if self._needs_normals:
            return elements.normals
        axes = np.eye(3)
        if self.mode == "AXIS" and self.orientation == "LOCAL":
            axes = elements.axes
        elif self.mode == "AXIS" and self.orientation == "VIEW":
            view = self.view
            assert view is not None
            axes = view.axes
            if self.axis == 2 and view.eye is not None:
                return unit(view.eye - elements.points)
        return np.broadcast_to(axes[..., self.axis], elements.points.shape)

    def _closest(
        self,
        surface: TargetSurface,
        points: np.ndarray,
        directions: np.ndarray,
        progress: Callable[[float], None],
    ) -> tuple[np.ndarray, np.ndarray]:
        facing: dict[str, Any] = {}
        if self.max_angle is not None:
            facing = {"facing": surface.outward * directions, "max_angle": self.max_angle}
        hits = surface.in_world.closest(points, self.max_distance, progress=progress, **facing)
        return hits.face, hits.uv

    def _on_lines(
        self,
        surface: TargetSurface,
        points: np.ndarray,
        directions: np.ndarray,
        progress: Callable[[float], None],
    ) -> tuple[np.ndarray, np.ndarray]:
        size = max(surface.size(), np.abs(points).max(initial=0.0))
        there = surface.in_world.closest(points, ON_SURFACE * size)
        face, uv = np.array(there.face), np.array(there.uv)
        away = np.flatnonzero(face < 0)
        best = np.full(len(away), np.inf)
        ways = WAYS[self.direction]
        for i, sign in enumerate(ways):
            hits = surface.in_world.ray_cast(
                points[away],
                sign * directions[away],
                self.max_distance,
                progress=part_of(progress, i / len(ways), (i + 1) / len(ways)),
            )
            distance = np.where(hits.face >= 0, hits.distance, np.inf)
            closer = distance < best
            best[closer] = distance[closer]
            face[away[closer]], uv[away[closer]] = hits.face[closer], hits.uv[closer]
        return face, uv

    def _missed(self) -> str:
        within = "" if np.isinf(self.max_distance) else f" within {self.max_distance:.6g}"
        if self.mode != "NEAREST":
            return f"no surface was found on the line of the search{within}"
        if self.max_angle is not None:
            return f"no surface that faces the same way was found{within}"
        return f"no surface was found{within}"
