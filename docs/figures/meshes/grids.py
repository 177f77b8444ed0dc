# SPDX-License-Identifier: Apache-2.0
"""Quads in rows and columns, and quads around a vertex: how they are connected, without places."""

from typing import NamedTuple

import numpy as np


def grid_faces(columns: int, rows: int) -> np.ndarray:
    """The faces of a grid, (rows * columns, 4), whose vertices are numbered row by row."""
    first = ((columns + 1) * np.arange(rows)[:, None] + np.arange(columns)).ravel()
    return first[:, None] + np.array([0, 1, columns + 2, columns + 1])


class Fan(NamedTuple):
    """Sectors of side x side quads around a vertex. Each vertex stands `i` steps along its sector's
    first spoke and `j` steps along its second one, which is the next sector's first."""

    sectors: int
    sector: np.ndarray
    i: np.ndarray
    j: np.ndarray
    faces: np.ndarray  # (sectors * side * side, 4), sector by sector, along the second spoke first

    def plan(self, angle: float = 2 * np.pi) -> np.ndarray:
        """Places in the plane, (vertices, 2): straight spokes of `side` steps of length 1, and
        sectors that are parallelograms and fill the angle."""
        turn = self.sector * (angle / self.sectors)
        following = (self.sector + 1) * (angle / self.sectors)
        first = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        second = np.stack([np.cos(following), np.sin(following)], axis=1)
        return self.i[:, None] * first + self.j[:, None] * second


def fan(sectors: int, side: int, closed: bool = True) -> Fan:
    """`closed`: the last sector's second spoke is the first one's first."""
    numbers: dict[tuple[int, int, int], int] = {}

    def vertex(sector: int, i: int, j: int) -> int:
        if i == 0 and (closed or sector + 1 < sectors):  # on the spoke shared with the next sector
            sector, i, j = (sector + 1) % sectors, j, 0
        key = (sector, i, j) if i or j else (0, 0, 0)
        return numbers.setdefault(key, len(numbers))

    faces = [
        [vertex(s, i, j), vertex(s, i + 1, j), vertex(s, i + 1, j + 1), vertex(s, i, j + 1)]
        for s in range(sectors)
        for i in range(side)
        for j in range(side)
    ]
    return Fan(sectors, *np.array(list(numbers)).T, np.array(faces))
