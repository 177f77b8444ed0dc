# SPDX-License-Identifier: GPL-3.0-or-later
"""A tessellation of an object's limit surface with all its attributes, as arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import cage, vertex_weights
from ..reading.subdivided_mesh import polygon_counts
from ..tasks.job import Progress, part_of
from ..tasks.object_keys import MaterialKey
from ..tasks.refused_faces import reasons
from ..tasks.request_size import RequestSize
from . import cage_attributes, levels
from .cage_attributes import Attribute, CageAttributes, Carrier

if TYPE_CHECKING:
    import limitsurf

# The parts of the progress at which the levels are chosen, and at which the polygons are made
_CHOSEN, _TESSELLATED = 0.3, 0.7


@dataclass(frozen=True)
class Groups:
    """The vertex groups of the cage or of the tessellation."""

    names: Sequence[str]
    weights: np.ndarray  # (vertices, groups)

    @classmethod
    def read(cls, mesh: bpy.types.Mesh, names: Sequence[str]) -> Groups:
        """Reads the weights from a mesh that has kept them; they are 0 in groups that modifiers
        drop.
        """
        weights = np.zeros((len(mesh.vertices), len(names)), np.float32)
        for i, found in enumerate(vertex_weights.read(mesh, len(names))):
            if found is not None:
                weights[:, i] = found
        return cls(names, weights)

    def by_name(self) -> dict[str, np.ndarray]:
        return dict(zip(self.names, self.weights.T, strict=True))


#: A function that returns the choice of levels for the mesh that a cage is read from, the cage and
#: its vertex groups
Chooser = Callable[[bpy.types.Mesh, cage.Cage, Groups], levels.Choice]


@dataclass(frozen=True)
class Source:
    """An object, read from Blender: all further work needs these arrays alone."""

    cage: cage.Cage
    attributes: CageAttributes
    groups: Groups
    materials: list[MaterialKey | None]
    choice: levels.Choice

    def make(self, exact_normals: bool, allow_large: bool, progress: Progress) -> Made:
        surface = self.cage.surface(in_world=True)
        refused = surface.refused
        if len(refused) == len(self.cage.face_sizes):
            raise RefusalError(f"No face has a limit surface: {reasons(refused)}")
        chosen, warning = self.choice(surface, part_of(progress, 0, _CHOSEN))
        RequestSize("polygons", _expected(self.cage, chosen, refused), 1, False).check(allow_large)
        surface.set_positions(self.cage.mesh.positions)
        tessellation = surface.tessellate(
            chosen,
            corner_normals=exact_normals,
            progress=part_of(progress, _CHOSEN, _TESSELLATED),
        )
        carrier = Carrier(self.attributes, surface, tessellation)
        rule = self.cage.rules.uv_interpolation
        on_it = list(carrier.attributes(rule, part_of(progress, _TESSELLATED, 1)))
        weights = carrier.weights(self.groups.weights) if self.groups.names else np.empty((0, 0))
        kept = np.delete(chosen, list(refused))
        return Made(
            self.cage,
            tessellation,
            on_it,
            carrier,
            Groups(self.groups.names, weights),
            self.materials,
            (int(kept.min()), int(kept.max())),
            refused,
            [warning] if warning else [],
        )


@dataclass(frozen=True)
class Made:
    cage: cage.Cage
    tessellation: limitsurf.Tessellation
    attributes: list[Attribute]
    carrier: Carrier  # makes the edges' attributes, once the mesh has numbered its edges
    groups: Groups
    materials: list[MaterialKey | None]  # those that modifiers add among them
    levels: tuple[int, int]  # the lowest and the highest level
    refused: Mapping[int, str]
    warnings: list[str]


def read(
    ob: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    choose: Chooser,
    with_sharp_faces: bool,
) -> Source:
    names = ob.vertex_groups.keys()
    with (
        vertex_weights.kept(names) as keep,
        cage.opened(ob, depsgraph, keep) as (found, mesh),
    ):
        groups = Groups.read(mesh, names)
        source = cage_attributes.read(mesh, with_sharp_faces)
        materials = [each and MaterialKey.of(each) for each in mesh.materials]
        return Source(found, source, groups, materials, choose(mesh, found, groups))


def _expected(found: cage.Cage, chosen: np.ndarray, refused: Mapping[int, str]) -> int:
    """Returns the expected number of polygons, without those that join faces of different
    levels.
    """
    counts = polygon_counts(found.face_sizes, chosen.astype(np.int64))
    counts[list(refused)] = 0
    return int(counts.sum())
