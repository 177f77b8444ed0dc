# SPDX-License-Identifier: GPL-3.0-or-later
"""Control points of curves and surfaces in Edit Mode; the handles of Bézier points move with
them.
"""

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import ragged_rows, splines
from .element_points import SnappedPoints


class SnappedCurvePoints(SnappedPoints):
    noun = "control points"

    def __init__(self, ob: bpy.types.Object) -> None:
        if ob.type == "CURVE" and ob.data.dimensions == "2D":
            raise RefusalError(f"{ob.name} is a 2D curve, which stays in its plane: make it 3D")
        super().__init__(ob)

    def read(self) -> tuple[np.ndarray, np.ndarray]:
        parts = [_read(spline) for spline in self.ob.data.splines]
        points, selected = zip(*parts, strict=True) if parts else ([], [])
        return (
            np.concatenate([np.empty((0, 3), np.float32), *points]),
            np.concatenate([np.empty(0, bool), *selected]),
        )

    def move(self, rows: np.ndarray, moves: np.ndarray) -> None:
        own = self.ob.data.splines
        sizes = np.array([len(splines.points(spline)) for spline in own], np.int64)
        starts = ragged_rows.starts(sizes)
        first, last = np.searchsorted(rows, starts), np.searchsorted(rows, starts + sizes)
        for spline, begin, end, start in zip(own, first, last, starts, strict=True):
            if begin < end:
                _move(spline, rows[begin:end] - start, moves[begin:end])
        self.ob.data.update_tag()


def _names(spline: bpy.types.Spline) -> tuple[str, ...]:
    return ("co", "handle_left", "handle_right") if spline.type == "BEZIER" else ("co",)


def _read(spline: bpy.types.Spline) -> tuple[np.ndarray, np.ndarray]:
    points = splines.points(spline)
    selected, hidden = np.empty((2, len(points)), bool)
    is_bezier = spline.type == "BEZIER"
    points.foreach_get("select_control_point" if is_bezier else "select", selected)
    points.foreach_get("hide", hidden)
    return splines.values(points, "co")[:, :3], selected & ~hidden


def _move(spline: bpy.types.Spline, rows: np.ndarray, moves: np.ndarray) -> None:
    points = splines.points(spline)
    for name in _names(spline):
        values = splines.values(points, name)
        values[rows, :3] = values[rows, :3].astype(np.float64) + moves
        points.foreach_set(name, values.ravel())
    # If points are assigned one by one, Blender calculates the automatic handles of the whole
    # spline each time.
    points[0].co = points[0].co
