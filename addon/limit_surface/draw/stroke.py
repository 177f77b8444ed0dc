# SPDX-License-Identifier: GPL-3.0-or-later
"""A stroke: a path on the surface, as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import BoolProperty, FloatProperty, FloatVectorProperty, IntProperty


@dataclass(frozen=True, eq=False)
class Stroke:
    """The points of a stroke. The last point of a closed stroke repeats the first."""

    face: np.ndarray  # (n,) int32
    uv: np.ndarray  # (n, 2)
    radius: np.ndarray  # (n,) as a share of the full radius: the pressure
    position: np.ndarray  # (n, 3) world
    normal: np.ndarray  # (n, 3) world; NaN where there is none
    is_closed: bool = False
    spline: int = -1  # the number of the spline that holds it unchanged; -1 for none

    def __len__(self) -> int:
        return len(self.face)

    def rows(self, rows: np.ndarray) -> Stroke:
        """Returns an open stroke of these points."""
        return Stroke(
            self.face[rows],
            self.uv[rows],
            self.radius[rows],
            self.position[rows],
            self.normal[rows],
        )

    def pieces(self, keeps: np.ndarray) -> list[Stroke]:
        """Returns what is left of the stroke without some of its points; itself if it keeps all."""
        if keeps.all():
            return [self]
        order = np.arange(len(self))
        if self.is_closed:  # it opens at the first point that it does not keep
            order = np.roll(order[:-1], -int(np.argmin(keeps[:-1])))
        kept = keeps[order]
        borders = np.flatnonzero(np.diff(np.concatenate([[False], kept, [False]])))
        runs = [order[begin:end] for begin, end in zip(borders[::2], borders[1::2], strict=True)]
        return [self.rows(run) for run in runs if len(run) > 1]


class LIMIT_PG_draw_point(bpy.types.PropertyGroup):
    """A point of a stroke, as scripts and the redo panel pass it to the operator."""

    face: IntProperty(
        name="Face", description="Number of the Ptex face on which the point lies", min=0
    )
    uv: FloatVectorProperty(
        name="UV",
        description="u and v of the point, 0 to 1",
        size=2,
        min=0.0,
        max=1.0,
        precision=6,
    )
    radius: FloatProperty(
        name="Radius",
        description="Radius at the point, as a fraction of the operator's radius. For a pen, this "
        "is its pressure",
        default=1.0,
        min=0.0,
    )
    is_first: BoolProperty(name="First", description="Whether a new stroke begins here")
    is_closed: BoolProperty(
        name="Closed", description="At the first point of a stroke: whether the stroke is closed"
    )


class LIMIT_PG_draw_spline(bpy.types.PropertyGroup):
    """A spline that the operator removes from the Curve object."""

    index: IntProperty(name="Index", description="Number of the spline, counted from 0", min=0)


def write(strokes: Sequence[Stroke], points: bpy.types.bpy_prop_collection) -> None:
    """Stores strokes in a collection of LIMIT_PG_draw_point. The repeated point of closed strokes
    is left out.
    """
    points.clear()
    if not strokes:
        return
    counts = [len(stroke) - stroke.is_closed for stroke in strokes]
    for _ in range(sum(counts)):
        points.add()

    def joined(name: str) -> np.ndarray:
        rows = [getattr(each, name)[:count] for each, count in zip(strokes, counts, strict=True)]
        return np.concatenate(rows)

    first = np.cumsum([0, *counts[:-1]])
    is_first, is_closed = np.zeros((2, len(points)), bool)
    is_first[first], is_closed[first] = True, [stroke.is_closed for stroke in strokes]
    points.foreach_set("face", joined("face"))
    points.foreach_set("uv", joined("uv").astype(np.float32).ravel())
    points.foreach_set("radius", joined("radius").astype(np.float32))
    points.foreach_set("is_first", is_first)
    points.foreach_set("is_closed", is_closed)


def count(points: bpy.types.bpy_prop_collection) -> int:
    """Returns the number of strokes in a collection of LIMIT_PG_draw_point."""
    return len(read(points))


def read(
    points: bpy.types.bpy_prop_collection,
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray, bool, int]]:
    """Returns the face, (u, v), radius and closedness of each stroke of a collection, and the
    number of its first point.
    """
    count = len(points)
    face, uv, radius = np.empty(count, np.int32), np.empty((count, 2), np.float32), np.empty(count)
    if not count:
        return []
    points.foreach_get("face", face)
    points.foreach_get("uv", uv.ravel())
    points.foreach_get("radius", radius)
    # Blender finds a point by its number only by counting from the first one.
    is_first, is_closed = np.zeros((2, count), bool)
    points.foreach_get("is_first", is_first)
    points.foreach_get("is_closed", is_closed)
    is_first[0] = True
    first = np.flatnonzero(is_first).tolist()
    ends = [*first[1:], count]
    return [
        (face[begin:end], uv[begin:end], radius[begin:end], bool(is_closed[begin]), begin)
        for begin, end in zip(first, ends, strict=True)
        if end > begin + 1
    ]
