# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads as renderers draw them: two flat triangles each, cut along the diagonal that Blender
chooses.

A place on a quad is given by two numbers: (0, 0) at the first corner, (1, 0) at the second, (1, 1)
and (0, 1) at the others. Positions are linear in them on each triangle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import ragged_rows


@dataclass(frozen=True)
class TriangulatedQuads:
    vertices: np.ndarray  # (v, 3)
    corners: np.ndarray  # (n, 4) vertices of each quad
    # (n,) true for quads that are cut from the second to the last corner, not from the first to the
    # third
    flipped: np.ndarray

    @classmethod
    def from_triangles(
        cls, vertices: np.ndarray, corners: np.ndarray, triangles: np.ndarray
    ) -> TriangulatedQuads:
        """Makes quads from Blender's triangles (2 n, 3), where all polygons are quads. The
        triangles refer to corners.
        """
        return cls(vertices, corners, _is_flipped(triangles[::2], 4 * np.arange(len(corners))))

    @classmethod
    def from_polygons(
        cls,
        vertices: np.ndarray,
        corner_vertex: np.ndarray,
        sizes: np.ndarray,
        triangles: np.ndarray,
    ) -> TriangulatedQuads:
        """Makes quads from polygons of any size: from a quad itself, and from any other polygon one
        quad for each corner, with the middles of the corner's two sides and the mean of all
        corners.
        """
        first = ragged_rows.starts(sizes)
        is_quad = sizes == 4
        split = ~np.repeat(is_quad, sizes)  # corners that get a quad of their own
        polygon = np.repeat(np.arange(len(sizes)), sizes)
        corner = np.arange(len(corner_vertex))
        following, before = ragged_rows.following(sizes), ragged_rows.preceding(sizes)

        middles = (vertices[corner_vertex] + vertices[corner_vertex[following]]) / 2
        centres = np.add.reduceat(vertices[corner_vertex], first) / sizes[:, None]
        middle_at = len(vertices) + corner
        centre_at = len(vertices) + len(corner) + polygon

        starts_quad = corner == first[polygon]
        kept = np.where(split, True, starts_quad)
        parts = np.stack([corner_vertex, middle_at, centre_at, middle_at[before]], axis=1)
        whole = corner_vertex[np.minimum(first[polygon, None] + np.arange(4), len(corner) - 1)]
        corners = np.where(split[:, None], parts, whole)[kept]
        first_triangle = ragged_rows.starts(sizes - 2)
        flipped = _is_flipped(triangles[first_triangle], first) & is_quad
        return cls(np.concatenate([vertices, middles, centres]), corners, flipped[polygon[kept]])

    def positions(self, quad: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Returns positions (n, 3)."""
        return np.einsum("ni,nij->nj", self._weights(quad, at), self.vertices[self.corners[quad]])

    def frames(self, quad: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Returns rotations (n, 3, 3) with the columns tangent along the first and third side,
        normal x tangent, and normal of the triangle. Where a triangle has no such tangent or no
        area, the columns are completed from the other sides, then from the axes.
        """
        lower = self._is_lower(quad, at)[:, None]
        first, second, third, last = self.vertices[self.corners[quad]].transpose(1, 0, 2)
        along = np.where(lower, second - first, third - last)
        ahead = np.where(lower ^ self.flipped[quad][:, None], third - second, last - first)
        return _completed(along, ahead)

    def vertices_at(self, quad: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Returns the vertices (n,) for places at corners."""
        x, y = at.astype(np.int64).T
        return self.corners[quad, np.where(y == 0, x, 3 - x)]

    def _is_lower(self, quad: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Tells whether a place is on the triangle with the quad's first side."""
        x, y = at.T
        return np.where(self.flipped[quad], x + y <= 1, x >= y)

    def _weights(self, quad: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Returns the weights (n, 4) of the corners."""
        x, y = at.T
        none = np.zeros_like(x)
        lower, flipped = self._is_lower(quad, at), self.flipped[quad]
        return np.select(
            [a[:, None] for a in (~flipped & lower, ~flipped & ~lower, flipped & lower)],
            [
                np.stack([1 - x, x - y, y, none], axis=1),
                np.stack([1 - y, none, x, y - x], axis=1),
                np.stack([1 - x - y, x, none, y], axis=1),
            ],
            np.stack([none, 1 - y, x + y - 1, 1 - x], axis=1),
        )


def _is_flipped(first_triangles: np.ndarray, first_corners: np.ndarray) -> np.ndarray:
    """Tells how quads are cut. Blender's first triangle of a quad has the corners 0, 1, 2, or 0, 1,
    3.
    """
    return (first_triangles - first_corners[:, None] == 3).any(axis=1)


def _completed(along: np.ndarray, ahead: np.ndarray) -> np.ndarray:
    """Returns rotations whose first axis has the direction of the first vectors; the third axis is
    at right angles to both.
    """
    tangent = _unit(along)
    tangent = np.where(_is_zero(tangent), _unit(ahead), tangent)
    tangent = np.where(_is_zero(tangent), [1.0, 0.0, 0.0], tangent)
    normal = _unit(np.cross(tangent, _unit(ahead)))
    axis = np.eye(3)[np.argmin(np.abs(tangent), axis=1)]
    normal = np.where(_is_zero(normal), _unit(np.cross(tangent, axis)), normal)
    return np.stack([tangent, np.cross(normal, tangent), normal], axis=2)


def _unit(vectors: np.ndarray) -> np.ndarray:
    """Returns unit vectors; zero for zero vectors."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def _is_zero(vectors: np.ndarray) -> np.ndarray:
    return ~vectors.any(axis=1, keepdims=True)
