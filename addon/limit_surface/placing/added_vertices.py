# SPDX-License-Identifier: GPL-3.0-or-later
"""Where vertices that were added to a mesh are in this frame: they are carried from the shape at
rest by their neighbours that have places, or if they have no such neighbour, by the nearest vertex
that has one.
"""

from __future__ import annotations

import bpy
import numpy as np

from .. import ids, native
from ..reading import attributes
from . import live_attributes, seals
from .posed_surface import PosedSurface, transformed
from .relocation import Elements, Relocation


class AddedVertices:
    """Of an object's elements, those without a place of their own that can be carried: `rows`."""

    def __init__(self, elements: Elements, posed: PosedSurface) -> None:
        mesh = elements.data
        self.rows: np.ndarray = np.empty(0, np.int64)
        if elements.broken is None or not elements.broken.any():
            return
        by = seals.carriers(mesh, elements.broken, elements.has_place)
        self.rows = np.flatnonzero(by != np.arange(len(by)))
        self._rest = attributes.read(mesh, _rest_name(mesh))[self.rows].astype(np.float64)
        self._turn, self._points = _carried(elements, posed, by[self.rows], self._rest)
        self._matrix = elements.matrix
        if _follows_live(mesh):  # they are shown where the nearest vertices carry them
            return
        row, neighbour = _neighbours(mesh, self.rows, elements.has_place)
        carried = _carried(elements, posed, neighbour, self._rest[row])[1]
        count = np.bincount(row, minlength=len(self.rows))
        sums = np.stack([np.bincount(row, c, len(self.rows)) for c in carried.T], axis=1)
        mean = sums / np.maximum(count, 1)[:, None]
        self._points = np.where(count[:, None], mean, self._points)

    def put_into(self, points: np.ndarray) -> None:
        """Changes the points of all elements, in the world, to where the rows are in this frame."""
        if len(self.rows):
            points[self.rows] = transformed(self._matrix, self._points)

    def put_back(self, relocation: Relocation) -> None:
        """Brings the places that the rows have just got in this frame to the shape at rest."""
        is_found = np.isin(self.rows, relocation.lost, invert=True)
        rows = self.rows[is_found]
        if not len(rows):
            return
        back = self._turn[is_found].transpose(0, 2, 1)
        offset = relocation.values[ids.REST_ROOT][rows] - self._points[is_found]
        root = self._rest[is_found] + np.einsum("nij,nj->ni", back, offset)
        frames = native.limitsurf.rotation_matrices(
            relocation.values[ids.REST_ROTATION][rows].astype(np.float64)
        )
        relocation.put(ids.REST_ROOT, rows, root)
        relocation.put(ids.REST_ROTATION, rows, native.limitsurf.quaternions(back @ frames))


def _carried(
    elements: Elements, posed: PosedSurface, by: np.ndarray, rest: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns how elements with places have turned since they were bound (n, 3, 3), and where
    points (n, 3) at rest go with them.
    """
    face, uv = elements.read(ids.FACE)[by], elements.read(ids.UV)[by].astype(np.float64)
    rotation = elements.read(ids.REST_ROTATION)[by].astype(np.float64)
    now = posed.places(face, uv, elements.matrix)
    turn = now.frame @ native.limitsurf.rotation_matrices(rotation).transpose(0, 2, 1)
    offset = rest - elements.read(ids.REST_ROOT)[by]
    return turn, now.position + np.einsum("nij,nj->ni", turn, offset)


def _neighbours(
    mesh: bpy.types.Mesh, rows: np.ndarray, has_place: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns pairs: an index into the rows, and a vertex with a place that an edge leads to."""
    number = np.full(len(has_place), -1)
    number[rows] = np.arange(len(rows))
    edges = attributes.edge_ends(mesh)
    begin, end = np.concatenate([edges, edges[:, ::-1]]).T
    found = (number[begin] >= 0) & has_place[end]
    return number[begin[found]], end[found]


def _follows_live(mesh: bpy.types.Mesh) -> bool:
    return not live_attributes.missing(mesh)


def _rest_name(mesh: bpy.types.Mesh) -> str:
    """Returns the name of the attribute that holds the shape at rest."""
    return live_attributes.rest_name(ids.POSITION) if _follows_live(mesh) else ids.POSITION
