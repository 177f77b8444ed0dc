# SPDX-License-Identifier: GPL-3.0-or-later
"""Partings: edges of the control mesh, and curves, across which no child follows a guide."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import bpy
import numpy as np
from bpy.props import EnumProperty, StringProperty

from .. import ids
from ..errors import RefusalError
from ..reading import attributes, curve_lines
from ..reading.named import find_object
from ..sources.source_mesh import SourceMesh
from ..sources.value_properties import search
from ..sources.values import labelled

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
                "Face Attribute",
                "Part between faces that have different values of an attribute",
                "",
                3,
            ),
            ("MATERIALS", "Materials", "Part between faces of different material slots", "", 4),
            (
                "CURVES",
                "Curves",
                "Part along the curves of an object, which are laid onto the surface",
                "",
                5,
            ),
        ),
        default="NONE",
    )
    parting_attribute: StringProperty(
        name="Parting Attribute",
        description="Name of the Boolean edge attribute that is true along the parting, or of the "
        "integer or Boolean face attribute that tells regions apart",
    )
    parting_curves: StringProperty(
        name="Parting Curves",
        description="Name of the curve or hair object along whose curves the hair is parted. They "
        "may lie on the surface or near it",
    )


class Parting(NamedTuple):
    """Arguments of LimitSurface.guide_weights."""

    cuts: np.ndarray  # (n, 2): edges of the control mesh by their vertices
    cut_points: np.ndarray  # (m, 3) in the world
    cut_offsets: np.ndarray  # (curves + 1,)


@dataclass(frozen=True)
class PartingChoice:
    """The chosen parting, of which curves have been read already."""

    kind: str
    attribute: str
    lines: np.ndarray  # (n, 2, 3) of curves in the world

    def wanted_vertex_groups(self, _ob: bpy.types.Object) -> list[str]:
        return []

    def read(self, mesh: SourceMesh) -> Parting:
        edges = attributes.read(mesh.mesh, ids.EDGE_VERTICES)
        return Parting(edges[self._is_cut(mesh)], *curve_lines.joined(self.lines))

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


def choice(properties: bpy.types.OperatorProperties, context: bpy.types.Context) -> PartingChoice:
    """Returns the choice. Raises RefusalError if curves are chosen and there are none."""
    lines = np.empty((0, 2, 3))
    if properties.parting == "CURVES":
        with labelled("Parting"):
            ob = find_object(properties.parting_curves, "curves along which hair is parted")
            lines = curve_lines.read(ob, context.evaluated_depsgraph_get())
    return PartingChoice(properties.parting, properties.parting_attribute, lines)


def draw(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
) -> None:
    layout.prop(properties, "parting")
    if properties.parting == "CURVES":
        search(layout, properties, "parting_curves", bpy.data, "objects")
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
