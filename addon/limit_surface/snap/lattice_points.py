# SPDX-License-Identifier: GPL-3.0-or-later
"""Points of lattices in Edit Mode."""

import numpy as np

from .element_points import SnappedPoints


class SnappedLatticePoints(SnappedPoints):
    noun = "lattice points"

    def read(self) -> tuple[np.ndarray, np.ndarray]:
        points = self.ob.data.points
        selected = np.empty(len(points), bool)
        points.foreach_get("select", selected)
        return self._positions(), selected

    def move(self, rows: np.ndarray, moves: np.ndarray) -> None:
        values = self._positions()
        values[rows] = values[rows].astype(np.float64) + moves
        self.ob.data.points.foreach_set("co_deform", values.ravel())
        self.ob.data.update_tag()

    def _positions(self) -> np.ndarray:
        points = self.ob.data.points
        values = np.empty((len(points), 3), np.float32)
        points.foreach_get("co_deform", values.ravel())
        return values
