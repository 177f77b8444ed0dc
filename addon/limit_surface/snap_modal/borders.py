# SPDX-License-Identifier: GPL-3.0-or-later
"""Sides of faces that are edges of the cage, and the points on them that are closest to the mouse.

A side is a straight line in a Ptex face's (u, v), so the points that are found lie exactly on the
border.
"""

import numpy as np

from ..reading import ragged_rows
from ..snap.surface import TargetSurface
from ..viewport.ray import Ray

STEPS = np.linspace(0, 1, 17)
PASSES = 4  # each step divides the interval by 8, until it is far smaller than a pixel


class Borders:
    def __init__(self, surface: TargetSurface) -> None:
        self._surface = surface.in_world
        mesh = surface.cage.mesh
        sizes = np.asarray(mesh.face_sizes)
        edge, is_boundary = _edges(sizes, np.asarray(mesh.face_vertices))
        base, corner = np.asarray(self._surface.base_face), np.asarray(self._surface.corner)
        quads = np.flatnonzero(sizes[base] == 4)
        others = np.flatnonzero(sizes[base] != 4)
        sides = [
            (faces, begin, end, first[base[faces]] + (corner[faces] + ahead) % sizes[base[faces]])
            for first in [ragged_rows.starts(sizes)]
            for faces, begin, end, ahead in (
                (quads, (0, 0), (1, 0), 0),
                (quads, (1, 0), (1, 1), 1),
                (quads, (1, 1), (0, 1), 2),
                (quads, (0, 1), (0, 0), 3),
                (others, (0, 0), (1, 0), 0),
                (others, (0, 1), (0, 0), -1),
            )
        ]
        self._face = np.concatenate([faces for faces, *_rest in sides])
        self._begin = np.concatenate([np.tile(begin, (len(f), 1)) for f, begin, *_r in sides])
        self._end = np.concatenate([np.tile(end, (len(f), 1)) for f, _begin, end, _edge in sides])
        corner_of_side = np.concatenate([corners for *_rest, corners in sides])
        evaluable = ~np.isin(base[self._face], list(self._surface.refused) + list(mesh.holes))
        self._evaluable = evaluable
        self._boundary = np.flatnonzero(is_boundary[edge[corner_of_side]] & evaluable)
        self._boundary_points = self._points(self._boundary, self._uv(self._boundary, STEPS))

    @property
    def has_boundary(self) -> bool:
        return len(self._boundary) > 0

    def nearest_of_face(self, face: int, ray: Ray) -> tuple[int, np.ndarray]:
        """Returns the face and (u, v) of the point on the face's border that is closest on
        screen.
        """
        rows = np.flatnonzero((self._face == face) & self._evaluable)
        return self._nearest(rows, self._points(rows, self._uv(rows, STEPS)), ray)

    def nearest_of_boundary(self, ray: Ray) -> tuple[int, np.ndarray]:
        return self._nearest(self._boundary, self._boundary_points, ray)

    def _nearest(self, rows: np.ndarray, points: np.ndarray, ray: Ray) -> tuple[int, np.ndarray]:
        at = STEPS
        for _ in range(PASSES):
            side, step = np.unravel_index(np.argmin(ray.apart(points)), points.shape[:2])
            rows = rows[[side]]
            uv = self._uv(rows, at)[0, step]
            before, after = max(int(step) - 1, 0), min(int(step) + 1, len(at) - 1)
            at = np.linspace(at[before], at[after], len(at))
            points = self._points(rows, self._uv(rows, at))
        return int(self._face[rows[0]]), uv

    def _uv(self, rows: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Returns the (u, v) of points on the sides, (sides, steps, 2)."""
        begin, end = self._begin[rows, None, :], self._end[rows, None, :]
        return (1 - at)[None, :, None] * begin + at[None, :, None] * end

    def _points(self, rows: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Returns the positions of points on the sides, (sides, steps, 3)."""
        face = np.repeat(self._face[rows], uv.shape[1])
        return self._surface.evaluate(face, uv.reshape(-1, 2)).position.reshape(*uv.shape[:2], 3)


def _edges(sizes: np.ndarray, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns for each face corner the edge that leads to the next corner, and for each edge
    whether it has only one face.
    """
    following = vertices[ragged_rows.following(sizes)]
    low, high = np.sort(np.stack([vertices, following]).astype(np.int64), axis=0)
    pair = low * (high.max() + 1) + high
    _pairs, edge, count = np.unique(pair, return_inverse=True, return_counts=True)
    return edge.ravel(), count == 1
