# SPDX-License-Identifier: Apache-2.0
"""How far Blender's subdivided mesh is from the limit surface: for the tables and the tests."""

from collections.abc import Callable

import bpy
import limitsurf
import numpy as np
from limit_surface import ids
from limit_surface.reading import attributes, cage, sharpness, subdivided_mesh
from limit_surface.reading.subdivided_mesh import SurfaceLocations


class Comparison:
    """An object whose first modifier is a Subdivision Surface, and its limit surface."""

    def __init__(self, ob: bpy.types.Object, levels: int, use_limit_surface: bool = True) -> None:
        self._ob = ob
        self._subsurf = ob.modifiers[0]
        self._subsurf.use_limit_surface, self._subsurf.levels = use_limit_surface, levels
        self.cage = cage.read(ob, bpy.context.evaluated_depsgraph_get())
        self.surface = limitsurf.LimitSurface(self.cage.mesh)
        self.corners = subdivided_mesh.corner_locations(self.cage.face_sizes, levels)
        shown = self._shown(1)
        self._corner_vertex = attributes.read(shown, ids.CORNER_VERTEX)
        self.vertices = subdivided_mesh.vertex_locations(
            self.corners, self._corner_vertex, len(shown.vertices)
        )

    def positions(self, quality: int) -> np.ndarray:
        """Each vertex's distance from its place, relative to the diagonal of the cage; NaN where
        there is no surface."""
        shown = attributes.read(self._shown(quality), "position")
        diagonal = np.linalg.norm(np.ptp(self.cage.mesh.positions, axis=0))
        expected = self._evaluate(self.vertices, lambda *at: self.surface.evaluate(*at).position)
        return np.linalg.norm(shown - expected, axis=1) / diagonal

    def uvs(self, quality: int) -> np.ndarray:
        """Each face corner's distance from its place on the UV map; the same."""
        found = self.cage.uv_map
        smooth = self.surface.face_varying(
            found.values, found.indices, self.cage.rules.uv_interpolation
        )
        expected = self._evaluate(self.corners, lambda *at: smooth.evaluate(*at).value)
        shown = attributes.read(self._shown(quality), found.name)
        return np.linalg.norm(shown - expected, axis=1)

    def lagging(self) -> tuple[np.ndarray, np.ndarray]:
        """Which vertices, and which corners, Blender shows short of the limit at any quality.

        Its subdivision ends with a patch around the vertex, however small. At darts (the inner
        end of a single sharp crease) that patch is off, and so it is, after as many steps as the
        sharpness lasts, at a smooth corner of the surface. UVs are off only at corners of islands,
        if they are smooth (under Smooth All) and the vertex has a fractional sharpness.
        """
        mesh = self._ob.data
        sharp = sharpness.read(mesh, self.cage.rules.use_creases, mesh.name)
        ends = attributes.read(mesh, ids.EDGE_VERTICES)
        faces = np.bincount(attributes.read(mesh, ids.CORNER_EDGE), minlength=len(mesh.edges))
        count = len(self.vertices.face)

        def meeting(some: np.ndarray) -> np.ndarray:
            return np.bincount(some.ravel(), minlength=count)

        infinite = sharp.edges[sharp.edge_values >= sharpness.INFINITE]
        value = np.zeros(count)
        value[sharp.vertices] = sharp.vertex_values
        inner = meeting(ends[faces != 2]) == 0
        held = value >= sharpness.INFINITE
        dart = inner & ~held & (meeting(infinite) == 1)
        decaying = (value > 0) & ~held
        pinned = self.cage.rules.boundary == "corners"
        corner = (meeting(ends[faces > 0]) == 2) & ~(pinned & ~inner)
        return dart | (decaying & corner), self._at_lone_corners(decaying)

    def _at_lone_corners(self, vertices: np.ndarray) -> np.ndarray:
        """Which corners stand at one of these vertices between two edges that are seams."""
        if self.cage.rules.uv_interpolation != "none":
            return np.zeros(len(self._corner_vertex), bool)
        cage_vertex = attributes.read(self._ob.data, ids.CORNER_VERTEX)
        sizes = self.cage.face_sizes
        corner, ends = np.arange(sizes.sum()), np.cumsum(sizes)
        before = corner - 1
        before[ends - sizes] = ends - 1
        seam = self._seams(before)
        lone = vertices[cage_vertex] & seam & seam[before]
        cage_face = np.repeat(np.arange(len(sizes)), sizes)
        shown_face = np.asarray(self.surface.base_face)[self.corners.face]
        # A face and a vertex of it, as one number
        return np.isin(
            shown_face * len(vertices) + self._corner_vertex,
            cage_face[lone] * len(vertices) + cage_vertex[lone],
        )

    def _seams(self, before: np.ndarray) -> np.ndarray:
        """Whether no other face shares both UV values of the edge that leaves a corner."""
        start = self.cage.uv_map.indices
        end = np.empty_like(start)
        end[before] = start
        pairs = np.sort(np.stack([start, end], axis=1), axis=1)
        _, which, count = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
        return count[which] != 2

    def _shown(self, quality: int) -> bpy.types.Mesh:
        self._subsurf.quality = quality
        return self._ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data

    def _evaluate(self, at: SurfaceLocations, evaluate: Callable[..., np.ndarray]) -> np.ndarray:
        refused = np.fromiter(self.surface.refused, np.int64)
        base_face = np.asarray(self.surface.base_face)
        there = (at.face >= 0) & ~np.isin(base_face[at.face], refused)
        values = evaluate(at.face[there], at.uv[there])
        everywhere = np.full((len(at.face), values.shape[1]), np.nan)
        everywhere[there] = values
        return everywhere
