# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh from which sources are read: that of the cage, after the modifiers before it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import attributes, cage, uv_map, vertex_weights
from ..reading.uv_map import UvMap


class Choice(Protocol):
    """A choice of a source that has not been read yet."""

    def wanted_vertex_groups(self, ob: bpy.types.Object) -> list[str]:
        """Returns the names of the groups whose weights are needed. Raises RefusalError for groups
        that the object has not.
        """

    def read(self, mesh: SourceMesh) -> Any:
        """Returns what the source holds, as arrays; None where nothing is chosen. Raises
        RefusalError where the source does not exist, or holds something else.
        """


@dataclass(frozen=True)
class SourceMesh:
    ob: bpy.types.Object
    mesh: bpy.types.Mesh
    cage: cage.Cage
    depsgraph: bpy.types.Depsgraph
    weights: Mapping[str, np.ndarray | None]  # of vertex groups; None: the modifiers remove it

    def find_uv_map(self, name: str, image: str) -> UvMap:
        """Returns the UV map that places an image: the active one if no name is given."""
        if not name:
            if self.cage.uv_map is None:
                why = self.cage.without_uv_map or f"{self.ob.name} has no UV map: unwrap it first"
                raise RefusalError(f"The image {image} cannot be placed: {why}")
            return self.cage.uv_map
        if name not in self.mesh.uv_layers:
            raise RefusalError(f"{self.ob.name} has no UV map {name!r} where it is subdivided")
        if not np.isfinite(attributes.read(self.mesh, name)).all():
            raise RefusalError(f"The UV map {name} has coordinates that are not finite numbers")
        return uv_map.read(self.mesh, name)

    def find_attribute(self, name: str) -> bpy.types.Attribute:
        if not name:
            raise RefusalError(f"Choose an attribute of {self.ob.name}")
        found = self.mesh.attributes.get(name)
        if found is None:
            if name in self.ob.data.attributes:
                raise RefusalError(f"{self.ob.name}: the modifiers remove the attribute {name}")
            raise RefusalError(f"{self.ob.name} has no attribute {name!r}")
        return found


def wanted_vertex_groups(ob: bpy.types.Object, choices: Iterable[Choice]) -> list[str]:
    """Returns the names of the groups that all choices need, each once."""
    names = (name for choice in choices for name in choice.wanted_vertex_groups(ob))
    return list(dict.fromkeys(names))


def vertex_group(ob: bpy.types.Object, name: str) -> str:
    """Returns the name of the group: that of the active one if no name is given. Raises
    RefusalError where the object has no such group, or its weights cannot be read.
    """
    if not name:
        active = ob.vertex_groups.active
        if active is None:
            raise RefusalError(_without(ob, "vertex group", bool(ob.vertex_groups)))
        name = active.name
    if name not in ob.vertex_groups:
        raise RefusalError(f"{ob.name} has no vertex group {name!r}")
    if name in ob.data.attributes:
        raise RefusalError(
            f"{ob.name} has an attribute with the same name as the vertex group {name}, which "
            "hides the group: rename the group"
        )
    return name


def color_attribute(ob: bpy.types.Object, name: str) -> str:
    """Returns the name of the color attribute: that of the active one if no name is given. Raises
    RefusalError where there is none.
    """
    if name:
        return name
    active = ob.data.color_attributes.active_color
    if active is None:
        raise RefusalError(_without(ob, "color attribute", bool(ob.data.color_attributes)))
    return str(active.name)


def _without(ob: bpy.types.Object, kind: str, has_others: bool) -> str:
    if has_others:
        return (
            f"{ob.name} has no active {kind}: name one, or click one in its Object Data properties"
        )
    return (
        f"{ob.name} has no {kind}: add one in its Object Data properties, or choose another source"
    )


def read_weights(mesh: bpy.types.Mesh, names: list[str]) -> dict[str, np.ndarray | None]:
    return dict(zip(names, vertex_weights.read(mesh, len(names)), strict=True))
