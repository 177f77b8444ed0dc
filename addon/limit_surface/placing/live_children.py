# SPDX-License-Identifier: GPL-3.0-or-later
"""Live children: a table with the place and the guides of each, and an object whose modifier grows
them. The object stores the settings that they were made with, so that they can be made again.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..nodes import children as nodes
from ..nodes import groups
from ..nodes.children import CHILDREN
from ..reading import attributes
from ..reading.users import own_objects_using
from . import following, tables
from .all_tiles import AllTiles
from .new_objects import add_on_surface
from .roots import Locations

#: The number of guides that a live child has
MOST_GUIDES = len(nodes.GUIDE)


@dataclass(frozen=True)
class Table:
    """The table's vertices as arrays."""

    place: np.ndarray  # (n, 3) float32: u, v, face
    guide: np.ndarray  # (n, MOST_GUIDES) int32: strands of the guides
    weights: np.ndarray  # (n, 3) float32

    @classmethod
    def of(cls, at: Locations, strand: np.ndarray, weight: np.ndarray) -> Table:
        """Takes guides (n, k) as numbers of strands; those without weight may be any."""
        count, k = weight.shape
        place = np.column_stack([at.uv, at.face]).astype(np.float32)
        numbers, weights = np.zeros((count, MOST_GUIDES)), np.zeros((count, MOST_GUIDES))
        numbers[:, :k], weights[:, :k] = strand, weight
        return cls(place, numbers.astype(np.int32), weights[:, : MOST_GUIDES - 1])

    def fill(self, mesh: bpy.types.Mesh) -> None:
        tables.fill(mesh, self.place)
        for name, values in zip(nodes.GUIDE, self.guide.T, strict=True):
            attributes.write(mesh, name, "INT", "POINT", values)
        attributes.write(mesh, nodes.WEIGHTS, "FLOAT_VECTOR", "POINT", self.weights)


def add(
    context: bpy.types.Context,
    surface: bpy.types.Object,
    guides: bpy.types.Object,
    tiles: AllTiles,
    table: Table,
    inputs: dict[str, object],
    settings: dict[str, Any],
) -> bpy.types.Object:
    """Adds the object, its table and the tables of tiles. `inputs` are those of the modifier that
    say how the children look; `settings` are stored.
    """
    curves = bpy.data.hair_curves.new(ids.CHILDREN_OBJECT)
    holder = None
    try:
        curves.surface = surface
        for material in guides.data.materials:
            curves.materials.append(material)
        holder = tables.hidden_object(ids.CHILDREN_TABLE, surface)
        table.fill(holder.data)
        ob = add_on_surface(context, ids.CHILDREN_OBJECT, curves, surface)
    except BaseException:
        if holder is not None:
            tables.remove_object(holder)
        bpy.data.hair_curves.remove(curves)
        raise
    modifier = groups.add_modifier(ob, CHILDREN)
    groups.set_input(modifier, nodes.TABLE, holder)
    for name, value in inputs.items():
        groups.set_input(modifier, name, value)
    _connect(ob, surface, guides, tiles, settings)
    return ob


def make_again(
    ob: bpy.types.Object,
    surface: bpy.types.Object,
    guides: bpy.types.Object,
    tiles: AllTiles,
    table: Table,
    settings: dict[str, Any],
) -> None:
    """Gives live children another table, and leaves how they look as users have set it."""
    modifier = modifier_of(ob)
    assert modifier is not None
    if not CHILDREN.matches(modifier.node_group):
        modifier.node_group = CHILDREN.group()
    before = table_of(ob)
    if before is not None and tables.readers(before) != [ob]:  # a copy of the children reads it
        before = None
    holder = tables.hidden_object(ids.CHILDREN_TABLE, surface, before)
    table.fill(holder.data)
    groups.set_input(modifier, nodes.TABLE, holder)
    _connect(ob, surface, guides, tiles, settings)


def _connect(
    ob: bpy.types.Object,
    surface: bpy.types.Object,
    guides: bpy.types.Object,
    tiles: AllTiles,
    settings: dict[str, Any],
) -> None:
    modifier = modifier_of(ob)
    assert modifier is not None
    for name, value in (
        (nodes.SURFACE, surface),
        (nodes.TILES, tiles.write()),
        (nodes.GUIDES, guides),
        (nodes.GUIDE_COUNT, len(guides.data.curves)),
        (nodes.TOPOLOGY, tiles.topology),
    ):
        groups.set_input(modifier, name, value)
    ob[ids.SIGNATURE] = tiles.signature
    ob[ids.CHILDREN_SETTINGS] = json.dumps(settings)
    ob[ids.CHILDREN_GUIDES] = _sum_of_roots(guides)
    tables.remove_unread()


def _sum_of_roots(guides: bpy.types.Object) -> str:
    """Returns a checksum of the places at which the guides' roots are bound."""
    checksum = 0
    for name in (ids.FACE, ids.UV):
        if name in guides.data.attributes:
            checksum = zlib.crc32(attributes.read(guides.data, name).tobytes(), checksum)
    return f"{checksum:08x}"


def modifier_of(ob: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """Returns the modifier that grows live children, if the object has it."""
    return next(groups.modifiers(ob, ids.CHILDREN_GROUP), None)


def table_of(ob: bpy.types.Object) -> bpy.types.Object | None:
    return groups.get_input(modifier_of(ob), nodes.TABLE)


def guides_of(ob: bpy.types.Object) -> bpy.types.Object | None:
    return groups.get_input(modifier_of(ob), nodes.GUIDES)


def surface_of(ob: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the surface on which live children grow; None for any other object."""
    modifier = modifier_of(ob)
    return groups.get_input(modifier, nodes.SURFACE) if modifier else None


def on_surface(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the file's own objects of live children on a surface."""
    return [ob for ob in own_objects_using(surface) if surface_of(ob) == surface]


def count_of(ob: bpy.types.Object) -> int:
    table = table_of(ob)
    return len(table.data.vertices) if table else 0


def settings_of(ob: bpy.types.Object) -> dict[str, Any]:
    """Returns the settings of the operator that made the children. Raises RefusalError where they
    are not known.
    """
    try:
        settings = json.loads(ob.get(ids.CHILDREN_SETTINGS, ""))
    except (TypeError, ValueError):
        settings = None
    if not isinstance(settings, dict):
        raise RefusalError(
            f"{ob.name} does not store the settings that its children were made with: delete it, "
            "and add the children again"
        )
    return settings


def obstacles(ob: bpy.types.Object, signature: str | None) -> Iterator[str]:
    """Yields why the children do not grow as they were made. The signature is that of the surface
    as it is now; without it, only what can be seen without an evaluation is named.
    """
    if table_of(ob) is None or groups.get_input(modifier_of(ob), nodes.TILES) is None:
        yield f"A hidden table that {ob.name} reads was deleted"
    guides = guides_of(ob)
    if guides is None or guides.type != "CURVES":
        yield (
            f"The guides of {ob.name} were deleted: choose other guides in its modifier, and run "
            "Rebind to Limit Surface"
        )
    else:
        before, now = groups.get_input(modifier_of(ob), nodes.GUIDE_COUNT), len(guides.data.curves)
        if before != now:
            yield f"The number of guides of {ob.name} has changed from {before:,} to {now:,}"
        elif ob.get(ids.CHILDREN_GUIDES, "") not in ("", _sum_of_roots(guides)):
            yield f"The guides of {ob.name} have other roots than when it was made"
    if signature and not following.holds(ob, signature):
        surface = surface_of(ob)
        name = surface.name if surface else ""
        yield f"The faces of {name} have changed since {ob.name} was made"
