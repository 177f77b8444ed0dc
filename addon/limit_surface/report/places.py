# SPDX-License-Identifier: GPL-3.0-or-later
"""Places all over a displayed mesh, and means over the area of its triangles.

Every polygon consists of one or more cells, each of which is cut into two triangles as the polygon
is. The places are the cells' corners, the middles of their sides and diagonals, and the centres of
the triangles. With the weights below they give the exact mean over a triangle of polynomials up to
the third degree; distances from a smooth surface are close to such polynomials.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..reading import cage, displayed_mesh, subdivided_mesh

# Places are measured in parts of this size, so that progress is shown and memory stays small.
PART = 1 << 17
ENOUGH = 100_000  # A polygon is only one cell where this already gives so many places.
MOST_CELLS = 8  # cells along each side of a polygon

CORNER_WEIGHT, MIDDLE_WEIGHT, CENTRE_WEIGHT = 1 / 20, 2 / 15, 9 / 20
# the corners of a cell's triangles, for cells that are not flipped and for those that are
_CENTRES = np.array([[(2, 1), (1, 2)], [(1, 1), (2, 2)]]) / 3


@dataclass(frozen=True)
class Patches:
    """Ptex faces that are measured in the same way."""

    faces: np.ndarray  # (n,)
    vertices: np.ndarray  # (n, 4) vertices of the cage at a quad's corners; (n, 1) at a part's
    cells: int  # number of cells along a side
    # (n, cells, cells) true for cells that are cut from the second corner to the last
    flipped: np.ndarray

    @property
    def count(self) -> int:
        """The number of places."""
        return len(self.faces) * _places(self.cells)

    def parts(self) -> Iterator[Patches]:
        step = max(PART // _places(self.cells), 1)
        for begin in range(0, len(self.faces), step):
            rows = slice(begin, begin + step)
            yield Patches(self.faces[rows], self.vertices[rows], self.cells, self.flipped[rows])

    def locations(self) -> tuple[np.ndarray, np.ndarray]:
        along = np.linspace(0, 1, 2 * self.cells + 1)
        grid = np.stack(np.meshgrid(along, along, indexing="ij"), axis=-1).reshape(-1, 2)
        cell = np.stack(np.meshgrid(*2 * [np.arange(self.cells)], indexing="ij"), axis=-1)
        centres = (cell[:, :, None] + _CENTRES[self.flipped.astype(np.int8)]) / self.cells
        count = len(self.faces)
        uv = np.concatenate(
            [np.broadcast_to(grid, (count, *grid.shape)), centres.reshape(count, -1, 2)], axis=1
        )
        return np.repeat(self.faces, uv.shape[1]), uv.reshape(-1, 2)

    def split(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Splits values at the locations into grids (n, along u, along v, ...) of corners and
        middles, and those (n, along u, along v, 2, ...) of the triangles' centres.
        """
        count, side = len(self.faces), 2 * self.cells + 1
        values = values.reshape(count, -1, *values.shape[1:])
        grid, centres = np.split(values, [side * side], axis=1)
        tail = values.shape[2:]
        return (
            grid.reshape(count, side, side, *tail),
            centres.reshape(count, self.cells, self.cells, 2, *tail),
        )

    def areas(self, positions: np.ndarray) -> np.ndarray:
        """Returns the areas (2, n, cells, cells) of the triangles of each cell, for positions at
        the locations.
        """
        first, second, third, last = _corners(self.split(positions)[0])
        flipped = self.flipped[..., None]
        one = np.cross(second - first, np.where(flipped, last, third) - first)
        other = np.cross(last - third, np.where(flipped, second, first) - third)
        return np.linalg.norm([one, other], axis=-1) / 2

    def sum(self, values: np.ndarray, areas: np.ndarray) -> float:
        """Integrates values over the area."""
        grid, centres = self.split(values)
        first, second, third, last = _corners(grid)
        sides, diagonal = _sides(grid), grid[:, 1::2, 1::2]
        corners = [
            first + second + np.where(self.flipped, last, third),
            third + last + np.where(self.flipped, second, first),
        ]
        middles = [
            sides[0] + diagonal + np.where(self.flipped, sides[3], sides[1]),
            sides[2] + diagonal + np.where(self.flipped, sides[1], sides[3]),
        ]
        means = (
            CORNER_WEIGHT * np.stack(corners)
            + MIDDLE_WEIGHT * np.stack(middles)
            + CENTRE_WEIGHT * np.moveaxis(centres, -1, 0)
        )
        return float(np.sum(areas * means))

    def keep_largest(self, at_vertices: np.ndarray, values: np.ndarray) -> None:
        """Stores at each vertex of a quad the largest value in its quarter, and at the vertex of a
        sub-face the largest in all of the sub-face.
        """
        grid, _ = self.split(values)
        low, high = slice(0, self.cells + 1), slice(self.cells, None)
        quarters = [(low, low), (high, low), (high, high), (low, high)]
        if self.vertices.shape[1] == 1:
            quarters = [(slice(None), slice(None))]
        for vertex, (columns, rows) in zip(self.vertices.T, quarters, strict=True):
            np.maximum.at(at_vertices, vertex, grid[:, columns, rows].max(axis=(1, 2)))


def patches(
    found: cage.Cage, shown: displayed_mesh.DisplayedMesh, refused: Mapping[int, str]
) -> list[Patches]:
    """Yields all faces but the refused ones: the quads, and the sub-faces of other faces."""
    sizes = found.face_sizes
    refuses = np.zeros(len(sizes), bool)
    refuses[list(refused)] = True
    kept = ~np.repeat(refuses, sizes)
    is_quad = np.repeat(sizes == 4, sizes)
    vertex, face = found.mesh.face_vertices, subdivided_mesh.cage_corners(sizes).face
    per_polygon = _cells_per_polygon(len(shown.quads.corners))
    result = []
    for corners, in_face, size in ((is_quad & kept, 4, 4), (~is_quad & kept, 1, 3)):
        if corners.any():
            faces = face[corners][::in_face]
            cells = per_polygon * subdivided_mesh.polygons_per_side(size, shown.level)
            flipped = _flipped(shown, faces, cells)
            result.append(Patches(faces, vertex[corners].reshape(-1, in_face), cells, flipped))
    return result


def _cells_per_polygon(polygons: int) -> int:
    """Returns the number of cells along a polygon's side."""
    return int(np.clip(np.sqrt(ENOUGH / (6 * polygons)), 1, MOST_CELLS))


def _flipped(shown: displayed_mesh.DisplayedMesh, faces: np.ndarray, cells: int) -> np.ndarray:
    middle = (np.arange(cells) + 0.5) / cells
    uv = np.stack(np.meshgrid(middle, middle, indexing="ij"), axis=-1).reshape(-1, 2)
    face = np.repeat(faces, len(uv))
    return shown.are_flipped(face, np.tile(uv, (len(faces), 1))).reshape(-1, cells, cells)


def _places(cells: int) -> int:
    """Returns the places of one face."""
    return (2 * cells + 1) ** 2 + 2 * cells**2


def _corners(grid: np.ndarray) -> list[np.ndarray]:
    """Returns the values at each cell's corners, in order around it."""
    low, high = slice(None, -2, 2), slice(2, None, 2)
    return [grid[:, i, j] for i, j in ((low, low), (high, low), (high, high), (low, high))]


def _sides(grid: np.ndarray) -> list[np.ndarray]:
    """Returns the values at the middles of each cell's sides, from the first side to the last."""
    odd, low, high = slice(1, None, 2), slice(None, -2, 2), slice(2, None, 2)
    return [grid[:, i, j] for i, j in ((odd, low), (high, odd), (odd, high), (low, odd))]
