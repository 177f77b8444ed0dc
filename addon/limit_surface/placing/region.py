# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a surface that is covered, and its density."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from .. import native
from ..errors import RefusalError
from ..reading import cage, subdivided_mesh, vertex_weights
from ..sources import source_mesh
from ..sources.source_mesh import Choice, SourceMesh
from ..tasks.refused_faces import reasons
from .border import BorderChoice, Edges
from .density import Density, DensityChoice, DensityMap
from .mask import MaskChoice
from .roots import Locations

if TYPE_CHECKING:
    import limitsurf

SAMPLES = 1 << 19  # the largest number of samples, roughly, for sums over the surface
MOST_PER_FACE = 64**2  # samples, if the density may be above 0 on the whole face
PLACES = 1 << 22  # the largest number of places among which these samples are
BORDER_SAMPLES = 4096

NOT_COVERED = "The faces that are chosen have no edges of this border"


@dataclass(frozen=True)
class Sums:
    """Sums over the faces that are covered; areas are measured in the world."""

    weight: float  # the mean of the density over the faces' (u, v)
    weighted_area: float
    largest: float  # density


@dataclass(frozen=True)
class BorderSums:
    """Sums along the borders that are covered, in the world."""

    length: float
    weight: float  # the mean of the density, 1 at most


class Region:
    """The covered part of a surface, as arrays alone: all that is needed of Blender is read when
    the region is made.
    """

    def __init__(
        self,
        found: cage.Cage,
        bare: np.ndarray,
        density_map: DensityMap | None,
        sources: Mapping[str, Any],
        border: Border | None,
    ) -> None:
        self.cage = found
        self.sources = sources  # what the choices have read, by their names
        self._border = border
        self.bare = frozenset(bare.tolist())  # faces
        mesh = found.with_holes(bare) if len(bare) else found.mesh
        self.surface = native.limitsurf.LimitSurface(mesh)
        self.density: Density | None = density_map.on(self.surface) if density_map else None

    @cached_property
    def refused(self) -> dict[int, str]:
        """The faces that should be covered but have no surface, with the reasons."""
        refused = self.surface.refused
        return {face: reason for face, reason in refused.items() if face not in self.bare}

    @property
    def face_count(self) -> int:
        """The number of the mesh's faces that are covered."""
        return len(self.cage.face_sizes) - len(self.surface.refused)

    @cached_property
    def ptex_face_count(self) -> int:
        parts = subdivided_mesh.ptex_face_counts(self.cage.face_sizes)
        return int(parts.sum() - parts[list(self.surface.refused)].sum())

    @contextmanager
    def in_world(self) -> Iterator[None]:
        """Moves the surface to world space for as long as the context lasts. Where its object is
        neither turned nor scaled it stays: all lengths, areas and directions are those of the
        world, and what is calculated from the same pose before is kept.
        """
        if np.array_equal(self.cage.matrix[:3, :3], np.eye(3)):
            yield
            return
        self.surface.set_positions(self.cage.world_positions())
        try:
            yield
        finally:
            self.surface.set_positions(self.cage.mesh.positions)

    @cached_property
    def area(self) -> float:
        with self.in_world():
            return self.surface.area()

    @cached_property
    def sums(self) -> Sums:
        """Returns the sums. Where there is a density they come from samples: the same number on
        each square of the faces where the density may be above 0, at random places.
        """
        if self.density is None:
            return Sums(1.0, self.area, 1.0)
        counts = self.density.limits > 0
        faces = np.flatnonzero(counts.any(axis=(1, 2)))
        if not len(faces):
            return Sums(0.0, 0.0, 0.0)
        wanted = min(SAMPLES, len(faces) * MOST_PER_FACE) / counts[faces].mean()
        per_side = max(int(np.sqrt(min(wanted, PLACES) / len(faces))), 1)
        places = self.surface.scatter_jittered(per_side, 0, faces=faces)
        column, row = (places.uv * counts.shape[1]).astype(int).clip(max=counts.shape[1] - 1).T
        may_count = counts[places.face, row, column]
        at = Locations(places.face[may_count], places.uv[may_count])
        weight = self.density(at.face, at.uv)
        with self.in_world():
            tangents = self.surface.evaluate(at.face, at.uv, derivatives=1)
        assert tangents.du is not None
        assert tangents.dv is not None
        across = np.nan_to_num(np.cross(tangents.du, tangents.dv))
        area = np.linalg.norm(across, axis=1) / per_side**2
        mean = weight.clip(max=1).sum() / (self.ptex_face_count * per_side**2)
        return Sums(float(mean), float(weight @ area), weight.max(initial=0.0))

    @property
    def is_empty(self) -> bool:
        """Whether the density is 0 everywhere."""
        return self.density is not None and not (self.density.limits > 0).any()

    def edge_curves(self) -> limitsurf.EdgeCurves:
        """Returns the curves of the border as the surface is now posed. Raises RefusalError where
        there are none.
        """
        assert self._border is not None
        curves = self.surface.edge_curves(self._border.edges)
        if not len(curves):
            raise RefusalError(NOT_COVERED if self.bare else self._border.missing)
        return curves

    @cached_property
    def border_sums(self) -> BorderSums:
        with self.in_world():
            curves = self.edge_curves()
            if not curves.lengths.sum() > 0:
                raise RefusalError("The border has no length")
            at = self.surface.scatter_along(curves, count=BORDER_SAMPLES)
        weight = np.ones(1) if self.density is None else self.density(at.face, at.uv)
        return BorderSums(float(curves.lengths.sum()), float(weight.clip(max=1).mean()))

    def measure(self) -> None:
        """Calculates the sums now. They are kept."""
        if self._border is None:
            self.sums  # noqa: B018 - asked for here, kept there
        else:
            self.border_sums  # noqa: B018


@dataclass(frozen=True)
class Border:
    """The edges along which things are placed, and what to say where there are none."""

    edges: Edges
    missing: str


def read(
    ob: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    density: DensityChoice,
    mask: MaskChoice,
    sources: Mapping[str, Choice] = MappingProxyType({}),
    border: BorderChoice | None = None,
) -> Region:
    """Reads the region, and what else is chosen. Raises RefusalError where there is nothing to
    cover, or a choice has no meaning here.
    """
    groups = source_mesh.wanted_vertex_groups(ob, [density, *sources.values()])
    with (
        vertex_weights.kept(groups) as keep,
        cage.opened(ob, depsgraph, keep) as (found, mesh),
    ):
        bare = mask.uncovered(mesh, ob.name)
        weights = source_mesh.read_weights(mesh, groups)
        read_from = SourceMesh(ob, mesh, found, depsgraph, weights)
        density_map = density.read(read_from)
        known = {name: choice.read(read_from) for name, choice in sources.items()}
        chosen = Border(border.read(mesh, ob.name), border.missing(ob.name)) if border else None
    covered = Region(found, bare, density_map, known, chosen)
    if not covered.face_count:
        raise RefusalError(f"No face has a limit surface: {reasons(covered.refused)}")
    return covered
