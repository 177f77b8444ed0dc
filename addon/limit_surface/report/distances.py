# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of a displayed mesh from the limit surface, in world units.

They are taken at the corners, the middles of the sides and the middle of every polygon that is
drawn, which lies on the diagonal between its two triangles. The largest is the largest of these;
the mean is over the area of the triangles, by the middles of each one's sides (right for functions
of second degree, and distances of triangles from a smooth surface are close to that).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from .. import cage, displayed, subdivided

if TYPE_CHECKING:
    import limitsurf

PART = 1 << 17  # so many places are looked at at once: a progress bar moves, memory stays small


@dataclass
class Spread:
    """Of one distance over the displayed mesh."""

    largest: float = 0.0
    _sum: float = field(default=0.0, repr=False)
    _area: float = field(default=0.0, repr=False)

    @property
    def mean(self) -> float:
        return self._sum / self._area if self._area else 0.0

    def add(self, distance: np.ndarray, areas: np.ndarray) -> None:
        """Of grids of places, and the areas between the middles and the sides of polygons."""
        self.largest = max(self.largest, float(distance.max()))
        middle = distance[:, 1::2, 1::2]
        sides = _sides(distance)
        self._sum += float(np.sum(areas * (2 * sides + middle)) / 3)
        self._area += float(areas.sum())


@dataclass
class Distances:
    level: int
    apart: Spread  # from the nearest point of the limit surface
    slide: Spread  # from the same place of the limit surface: the same face, u and v
    at_vertices: np.ndarray  # (v,) the largest `apart` around each vertex of the cage


def measure(
    surface: limitsurf.LimitSurface,
    found: cage.Cage,
    shown: displayed.DisplayedMesh,
    progress: Callable[[float], None],
) -> Distances:
    """Of all faces that have a limit surface; `surface` is that of the cage in the world."""
    groups = list(_alike(found, shown.level, surface.refused))
    total = sum(len(group.faces) * group.places for group in groups)
    done = 0
    result = Distances(shown.level, Spread(), Spread(), np.zeros(len(found.mesh.positions)))
    for group in groups:
        for part in group.parts():
            face, uv = part.locations()
            position = found.to_world(shown.positions(face, uv))
            apart = part.as_grids(surface.closest(position).distance)
            same_place = surface.evaluate(face, uv).position
            slide = part.as_grids(np.linalg.norm(position - same_place, axis=1))
            areas = _areas(part.as_grids(position))
            result.apart.add(apart, areas)
            result.slide.add(slide, areas)
            part.keep_largest(result.at_vertices, apart)
            done += len(face)
            progress(done / total)
    return result


@dataclass(frozen=True)
class _Group:
    """Ptex faces with the same grid of places: the corners of its polygons, and halfway between."""

    faces: np.ndarray  # (n,)
    vertices: np.ndarray  # (n, 4) vertices of the cage at a quad's corners; (n, 1) at a part's
    per_side: int  # polygons along a side

    @property
    def places(self) -> int:
        """Of each face."""
        return (2 * self.per_side + 1) ** 2

    def parts(self) -> Iterator[_Group]:
        step = max(PART // self.places, 1)
        for begin in range(0, len(self.faces), step):
            rows = slice(begin, begin + step)
            yield _Group(self.faces[rows], self.vertices[rows], self.per_side)

    def locations(self) -> tuple[np.ndarray, np.ndarray]:
        along = np.linspace(0, 1, 2 * self.per_side + 1)
        uv = np.stack(np.meshgrid(along, along, indexing="ij"), axis=-1).reshape(-1, 2)
        return np.repeat(self.faces, len(uv)), np.tile(uv, (len(self.faces), 1))

    def as_grids(self, values: np.ndarray) -> np.ndarray:
        """(faces, along u, along v, ...)"""
        side = 2 * self.per_side + 1
        return values.reshape(len(self.faces), side, side, *values.shape[1:])

    def keep_largest(self, at_vertices: np.ndarray, grids: np.ndarray) -> None:
        """At each vertex of a quad the largest in its quarter, at a part's in all of it."""
        low, high = slice(None, self.per_side + 1), slice(self.per_side, None)
        quarters = ((low, low), (high, low), (high, high), (low, high))
        if self.vertices.shape[1] == 1:
            quarters = ((slice(None), slice(None)),)
        for vertex, (columns, rows) in zip(self.vertices.T, quarters, strict=True):
            np.maximum.at(at_vertices, vertex, grids[:, columns, rows].max(axis=(1, 2)))


def _alike(found: cage.Cage, level: int, refused: dict[int, str]) -> Iterator[_Group]:
    sizes = found.face_sizes
    refuses = np.zeros(len(sizes), bool)
    refuses[list(refused)] = True
    kept = ~np.repeat(refuses, sizes)
    is_quad = np.repeat(sizes == 4, sizes)
    vertex, face = found.mesh.face_vertices, subdivided.cage_corners(sizes).face
    for corners, in_face, size in ((is_quad & kept, 4, 4), (~is_quad & kept, 1, 0)):
        if corners.any():
            yield _Group(
                face[corners][::in_face],
                vertex[corners].reshape(-1, in_face),
                subdivided.polygons_per_side(size, level),
            )


def _sides(grids: np.ndarray) -> np.ndarray:
    """Values at the middles of each polygon's sides, from the first side to the last."""
    odd, low, high = slice(1, None, 2), slice(None, -2, 2), slice(2, None, 2)
    return np.stack([grids[:, i, j] for i, j in ((odd, low), (high, odd), (odd, high), (low, odd))])


def _areas(grids: np.ndarray) -> np.ndarray:
    """Of the triangles between the middle of each polygon and its sides: two of them make one of
    the triangles that are drawn."""
    low, high = slice(None, -2, 2), slice(2, None, 2)
    around = [grids[:, i, j] for i, j in ((low, low), (high, low), (high, high), (low, high))]
    middle = grids[:, 1::2, 1::2]
    spokes = [corner - middle for corner in around]
    pairs = zip(spokes, spokes[1:] + spokes[:1], strict=True)
    return np.stack([np.linalg.norm(np.cross(a, b), axis=-1) / 2 for a, b in pairs])
