# SPDX-License-Identifier: GPL-3.0-or-later
"""Live children: a table with the place and the guides of each, and an object whose modifier grows
them.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..nodes import children as nodes
from ..nodes import groups
from ..nodes.children import CHILDREN
from ..placing import tables
from ..placing.all_tiles import AllTiles
from ..placing.new_objects import add_on_surface
from ..placing.roots import Locations
from ..reading import attributes

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
    settings: dict[str, object],
) -> bpy.types.Object:
    """Adds the object, its table and the tables of tiles. `settings` are inputs of the modifier."""
    curves = bpy.data.hair_curves.new(ids.CHILDREN_OBJECT)
    holder = None
    try:
        curves.surface = surface
        for material in guides.data.materials:
            curves.materials.append(material)
        holder = tables.new_object(ids.CHILDREN_TABLE, surface)
        table.fill(holder.data)
        ob = add_on_surface(context, ids.CHILDREN_OBJECT, curves, surface)
    except BaseException:
        if holder is not None:
            tables.remove_object(holder)
        bpy.data.hair_curves.remove(curves)
        raise
    modifier = groups.add_modifier(ob, CHILDREN)
    for name, value in (
        (nodes.SURFACE, surface),
        (nodes.TILES, tiles.write()),
        (nodes.TABLE, holder),
        (nodes.GUIDES, guides),
        (nodes.GUIDE_COUNT, len(guides.data.curves)),
        (nodes.TOPOLOGY, tiles.topology),
        *settings.items(),
    ):
        groups.set_input(modifier, name, value)
    return ob
