# SPDX-License-Identifier: GPL-3.0-or-later
"""Partings: edges of the control mesh across which no child follows a guide."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import EnumProperty, StringProperty

from .. import ids
from ..errors import RefusalError
from ..reading import attributes
from ..sources.source_mesh import SourceMesh

_NAMED = ("EDGE_ATTRIBUTE", "FACE_ATTRIBUTE")


class PartingProperties:
    """Mixin with the properties that choose a parting."""

    parting: EnumProperty(
        name="Parting",
        description="Where hair is parted: children on one side do not follow guides on the other",
        items=(
            ("NONE", "None", "Part nowhere", "", 0),
            ("SEAMS", "Seams", "Part along the edges that are marked as UV seams", "", 1),
            (
                "EDGE_ATTRIBUTE",
                "Edge Attribute",
                "Part along the edges where an attribute is true",
                "",
                2,
            ),
            (
                "FACE_ATTRIBUTE",
                "Face Map",
                "Part between faces that have different values of an attribute",
                "",
                3,
            ),
            ("MATERIALS", "Materials", "Part between faces of different material slots", "", 4),
        ),
        default="NONE",
    )
    parting_attribute: StringProperty(
        name="Parting Attribute",
        description="Name of the Boolean edge attribute that is true along the parting, or of the "
        "integer or Boolean face attribute that tells regions apart",
    )


@dataclass(frozen=True)
class PartingChoice:
    """The chosen parting. `read` returns its edges, (n, 2) vertices."""

    kind: str
    attribute: str

    def wanted_vertex_groups(self, _ob: bpy.types.Object) -> list[str]:
        return []

    def read(self, mesh: SourceMesh) -> np.ndarray:
        edges = attributes.read(mesh.mesh, ids.EDGE_VERTICES)
        return edges[self._is_cut(mesh)]

    def _is_cut(self, mesh: SourceMesh) -> np.ndarray:
        data = mesh.mesh
        cut: np.ndarray = np.zeros(len(data.edges), bool)
        if self.kind == "SEAMS":
            data.edges.foreach_get("use_seam", cut)
            if not cut.any():
                raise RefusalError(f"{mesh.ob.name} has no edges that are marked as seams")
        elif self.kind == "EDGE_ATTRIBUTE":
            cut = self._named(mesh, "EDGE", ("BOOLEAN",)).astype(bool)
        elif self.kind == "FACE_ATTRIBUTE":
            values = self._named(mesh, "FACE", ("INT", "INT8", "BOOLEAN")).astype(np.int64)
            cut = _between(data, values)
        elif self.kind == "MATERIALS":
            slots = np.empty(len(data.polygons), np.int32)
            data.polygons.foreach_get("material_index", slots)
            cut = _between(data, slots)
        return cut & _has_faces(data)

    def _named(self, mesh: SourceMesh, domain: str, types: tuple[str, ...]) -> np.ndarray:
        found = mesh.find_attribute(self.attribute)
        if found.domain != domain or found.data_type not in types:
            raise RefusalError(
                f"The attribute {self.attribute} is of type {found.data_type} on {found.domain}: "
                f"the parting needs {' or '.join(types)} on {domain}"
            )
        return attributes.read(mesh.mesh, self.attribute)


def choice(properties: bpy.types.OperatorProperties) -> PartingChoice:
    return PartingChoice(properties.parting, properties.parting_attribute)


def draw(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
) -> None:
    layout.prop(properties, "parting")
    if properties.parting not in _NAMED:
        return
    if ob is None:
        layout.prop(properties, "parting_attribute", text="Attribute")
    else:
        layout.prop_search(properties, "parting_attribute", ob.data, "attributes", text="Attribute")


def _between(mesh: bpy.types.Mesh, values: np.ndarray) -> np.ndarray:
    """Tells which edges have faces of different values."""
    of_corner = np.repeat(values, attributes.face_sizes(mesh))
    edge = attributes.read(mesh, ids.CORNER_EDGE)
    low = np.full(len(mesh.edges), np.iinfo(np.int64).max)
    high = np.full(len(mesh.edges), np.iinfo(np.int64).min)
    np.minimum.at(low, edge, of_corner)
    np.maximum.at(high, edge, of_corner)
    return low < high


def _has_faces(mesh: bpy.types.Mesh) -> np.ndarray:
    edge = attributes.read(mesh, ids.CORNER_EDGE)
    return np.bincount(edge, minlength=len(mesh.edges)) > 0
