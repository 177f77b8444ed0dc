# SPDX-License-Identifier: Apache-2.0
"""Distances of the mesh that Blender shows from the limit surface."""

from functools import cached_property
from typing import NamedTuple

import bpy
import limitsurf
import numpy as np
from limit_surface import ids
from limit_surface.reading import attributes, cage, subdivided_mesh


class Distance(NamedTuple):
    """Each vertex's distance from its place on the limit surface, in mean edges of the cage."""

    whole: np.ndarray
    along: np.ndarray  # in the tangent plane of the limit surface
    across: np.ndarray  # along its normal


class Comparison:
    """The vertices of an object whose only modifier is a Subdivision Surface, at some levels, and
    the same places of its limit surface."""

    def __init__(self, ob: bpy.types.Object, levels: int) -> None:
        self._ob, self._subsurf, self.levels = ob, ob.modifiers[0], levels
        self.cage = cage.read(ob, bpy.context.evaluated_depsgraph_get())
        self.surface = limitsurf.LimitSurface(self.cage.mesh)
        self.corners = subdivided_mesh.corner_locations(self.cage.face_sizes, levels)
        mesh = self._evaluated(1)
        corner_vertex = attributes.read(mesh, ids.CORNER_VERTEX)
        self.quads = corner_vertex.reshape(-1, 4)
        self.places = subdivided_mesh.vertex_locations(
            self.corners, corner_vertex, len(mesh.vertices)
        )

    @cached_property
    def cage_edges(self) -> np.ndarray:
        """(edges, 2, 3)"""
        return self.cage.mesh.positions[attributes.read(self._ob.data, ids.EDGE_VERTICES)]

    @cached_property
    def exact(self) -> np.ndarray:
        return self.surface.evaluate(*self.places).position

    @cached_property
    def normals(self) -> np.ndarray:
        return self.surface.frames(*self.places)[:, :, 2]

    def shown(self, quality: int) -> np.ndarray:
        """Positions as Blender shows them."""
        return attributes.read(self._evaluated(quality), "position").astype(np.float64)

    @cached_property
    def mean_edge(self) -> float:
        return float(np.linalg.norm(np.diff(self.cage_edges, axis=1), axis=2).mean())

    def distance(self, quality: int) -> Distance:
        off = (self.shown(quality) - self.exact) / self.mean_edge
        across = np.einsum("ij,ij->i", off, self.normals)
        along = np.linalg.norm(off - across[:, None] * self.normals, axis=1)
        return Distance(np.linalg.norm(off, axis=1), along, np.abs(across))

    def parameter_lines(self, count: int) -> list[np.ndarray]:
        """The vertices along lines u = i / count and v = i / count of each quad, one line a row.
        On the parts of other faces, which are half as long, there are half as many."""
        sizes = self.cage.face_sizes[np.asarray(self.surface.base_face)]
        found = []
        for whole in (True, False):
            faces = np.flatnonzero((sizes == 4) == whole)
            side = 2**self.levels // (1 if whole else 2)
            step = max(2**self.levels // count, 1)
            here = np.isin(self.corners.face, faces)
            row = np.searchsorted(faces, self.corners.face[here])
            i, j = np.rint(self.corners.uv[here] * side).astype(int).T
            grid = np.zeros((len(faces), side + 1, side + 1), int)
            grid[row, j, i] = self.quads.ravel()[here]
            rows, columns = grid[:, ::step], grid[:, :, ::step].swapaxes(1, 2)
            found += [lines.reshape(-1, side + 1) for lines in (rows, columns)]
        return [lines for lines in found if len(lines)]

    def _evaluated(self, quality: int) -> bpy.types.Mesh:
        self._subsurf.levels, self._subsurf.quality = self.levels, quality
        return self._ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data


class UvComparison(Comparison):
    """The same for the UV map, as a flat surface. Every polygon has corners of its own."""

    def __init__(self, ob: bpy.types.Object, levels: int) -> None:
        super().__init__(ob, levels)
        self.places, self.quads = self.corners, np.arange(self.quads.size).reshape(-1, 4)

    @cached_property
    def cage_edges(self) -> np.ndarray:
        found = self.cage.uv_map
        sizes = self.cage.face_sizes
        last = np.cumsum(sizes) - 1
        following = np.arange(1, len(found.indices) + 1)
        following[last] = last - sizes + 1
        values = _flat(found.values)[found.indices]
        return np.stack([values, values[following]], axis=1)

    @cached_property
    def exact(self) -> np.ndarray:
        found = self.cage.uv_map
        smooth = self.surface.face_varying(
            found.values, found.indices, self.cage.rules.uv_interpolation
        )
        return _flat(smooth.evaluate(*self.places).value)

    @cached_property
    def normals(self) -> np.ndarray:
        return np.tile([0.0, 0.0, 1.0], (len(self.quads) * 4, 1))

    def shown(self, quality: int) -> np.ndarray:
        return _flat(attributes.read(self._evaluated(quality), self.cage.uv_map.name))


def compare(ob: bpy.types.Object, levels: int) -> Comparison:
    """Compares the UV map if the object has one, and else the mesh."""
    return (UvComparison if ob.data.uv_layers else Comparison)(ob, levels)


def _flat(uv: np.ndarray) -> np.ndarray:
    return np.column_stack([uv.astype(np.float64), np.zeros(len(uv))])
