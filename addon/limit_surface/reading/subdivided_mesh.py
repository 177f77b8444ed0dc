# SPDX-License-Identifier: GPL-3.0-or-later
"""The places on the cage of the vertices and face corners that Blender's Subdivision Surface makes,
and the polygon on which a place of the cage lies.

The modifier makes 2^levels x 2^levels polygons of a quad. Of any other face it makes half as many
along each side of each corner's part. The vertices of the cage come first, then those inside its
edges, then those inside its faces. Polygons come cage face by cage face, in the order of
`_quad_cells` and `_split_cells`. After a modifier that makes, removes or sorts elements none of
this holds.
"""

from typing import NamedTuple

import numpy as np

from .ragged_rows import places, starts

#: The (u, v) of a polygon's corners, in Blender's order, from the corner nearest to (0, 0)
_AROUND = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])


class SurfaceLocations(NamedTuple):
    face: np.ndarray  # (n,) Ptex faces; -1 where there is none
    uv: np.ndarray  # (n, 2), multiples of a power of two


class _Cells(NamedTuple):
    """The polygons of one cage face, in Blender's order."""

    part: np.ndarray  # (n,) Ptex faces, counted from the first one of the cage face
    cell: np.ndarray  # (n, 2) columns along u, rows along v


def corner_locations(face_sizes: np.ndarray, levels: int) -> SurfaceLocations:
    """Returns the location of every corner of every polygon, for a cage whose faces have so many
    corners.
    """
    if levels < 1:
        raise ValueError("Blender subdivides from level 1 on")
    first_ptex_face = starts(ptex_face_counts(face_sizes))
    polygons = polygon_counts(face_sizes, levels)
    first_polygon = starts(polygons)
    face = np.empty((polygons.sum(), 4), np.int32)
    uv = np.empty((polygons.sum(), 4, 2))
    for size in np.unique(face_sizes):
        per_side = polygons_per_side(size, levels)
        cells = _cells(size, per_side)
        alike = np.flatnonzero(face_sizes == size)
        rows = first_polygon[alike, None] + np.arange(len(cells.part))
        face[rows] = (first_ptex_face[alike, None] + cells.part)[:, :, None]
        uv[rows] = (cells.cell[:, None, :] + _AROUND) / per_side
    return SurfaceLocations(face.ravel(), uv.reshape(-1, 2))


def vertex_locations(
    corners: SurfaceLocations, corner_vertex: np.ndarray, vertex_count: int
) -> SurfaceLocations:
    """Returns the location of every vertex, taken from the first corner at it."""
    face = np.full(vertex_count, -1, np.int32)
    uv = np.zeros((vertex_count, 2))
    vertex, corner = np.unique(corner_vertex, return_index=True)
    face[vertex], uv[vertex] = corners.face[corner], corners.uv[corner]
    return SurfaceLocations(face, uv)


def cage_corners(face_sizes: np.ndarray) -> SurfaceLocations:
    """Returns the location of every corner of every face of the cage."""
    size_at = np.repeat(face_sizes, face_sizes)
    corner = places(face_sizes)
    parts = ptex_face_counts(face_sizes)
    first = np.repeat(starts(parts), face_sizes)
    is_quad = size_at == 4
    face = np.where(is_quad, first, first + corner)
    return SurfaceLocations(face, _AROUND[np.where(is_quad, corner, 0)].astype(np.float64))


def ptex_face_counts(face_sizes: np.ndarray) -> np.ndarray:
    return np.where(face_sizes == 4, 1, face_sizes)


def polygon_counts(face_sizes: np.ndarray, levels: int | np.ndarray) -> np.ndarray:
    """Returns the number of polygons of each cage face, from level 1 on; at level 0 a quad is one
    polygon. `levels` may be an array with one level for each face.
    """
    return np.where(face_sizes == 4, 4, face_sizes).astype(np.int64) * 4**levels // 4


class PolygonFinder:
    """Finds the polygon at a place of the cage, for a cage whose faces have so many corners."""

    def __init__(self, face_sizes: np.ndarray, levels: int) -> None:
        parts = ptex_face_counts(face_sizes)
        self._sizes, self._levels = face_sizes, levels
        self._base = np.repeat(np.arange(len(face_sizes)), parts)
        self._part = places(parts)
        self._first_polygon = starts(polygon_counts(face_sizes, levels))

    def find(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns polygons (n,), and the places on them (n, 2): (0, 0) at their first corner, (1,
        0) at the second, (0, 1) at the last. Where several polygons meet, the one towards (1, 1) is
        taken.
        """
        base, part = self._base[face], self._part[face]
        size_at = self._sizes[base]
        polygon, within = np.empty(len(face), np.int64), np.empty((len(face), 2))
        for size in np.unique(size_at):
            per_side = polygons_per_side(size, self._levels)
            cells = _cells(size, per_side)
            order = np.empty((size, per_side, per_side), np.int64)
            order[cells.part, cells.cell[:, 0], cells.cell[:, 1]] = np.arange(len(cells.part))
            at = np.flatnonzero(size_at == size)
            along = uv[at] * per_side
            cell = np.minimum(along.astype(np.int64), per_side - 1)
            polygon[at] = self._first_polygon[base[at]] + order[part[at], cell[:, 0], cell[:, 1]]
            within[at] = along - cell
        return polygon, within


def polygons_per_side(face_size: int, levels: int) -> int:
    """Returns the number of polygons along a side of a Ptex face; 1 at level 0."""
    return 2**levels if face_size == 4 else 2 ** max(levels - 1, 0)


def _cells(face_size: int, per_side: int) -> _Cells:
    return _quad_cells(per_side) if face_size == 4 else _split_cells(face_size, per_side)


def _quad_cells(side: int) -> _Cells:
    """Returns the polygons of a quad: the inner cells row by row, then those along each side in
    turn.
    """
    inner, along, end = np.arange(1, side - 1), np.arange(side - 1), side - 1
    return _joined(
        _rows(0, inner, inner),
        (0, along, 0),
        (0, end, along),
        (0, end - along, end),
        (0, 0, end - along),
    )


def _split_cells(size: int, side: int) -> _Cells:
    """Returns the polygons of a face that is split into a part for each corner: the inner cells of
    all parts, those beside the lines between parts, those at the centre, then those at the cage
    face's boundary.
    """
    parts = range(size)
    inner, along, upwards, end = (
        np.arange(1, side - 1),
        np.arange(side),
        np.arange(1, side),
        side - 1,
    )
    return _joined(
        *(_rows(part, upwards, inner) for part in parts),
        *(((part + 1) % size, inner, end) for part in parts),
        *((part, end, np.full(min(end, 1), end)) for part in parts),
        *(strip for part in parts for strip in ((part, along, 0), (part, 0, upwards))),
    )


_Strip = tuple[int, np.ndarray | int, np.ndarray | int]  # part, columns, rows


def _rows(part: int, columns: np.ndarray, rows: np.ndarray) -> _Strip:
    return part, np.tile(columns, len(rows)), np.repeat(rows, len(columns))


def _joined(*strips: _Strip) -> _Cells:
    parts, columns, rows = zip(*(np.broadcast_arrays(*strip) for strip in strips), strict=True)
    cell = np.stack([np.concatenate(columns), np.concatenate(rows)], axis=1)
    return _Cells(np.concatenate(parts), cell)
