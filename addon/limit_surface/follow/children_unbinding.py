# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns live children into curves, as they are in this frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..nodes import children as nodes
from ..nodes import groups
from ..placing import following, live_children, tables
from ..placing.binding import Binding
from ..placing.new_hair import Strands
from ..placing.places import ROOT_KINDS
from ..placing.posed_surface import PosedSurface
from ..placing.roots import Locations
from ..reading import attributes, cage, transform
from ..tasks.piecewise_job import Pieces


@dataclass(frozen=True)
class _Curves:
    """What live children are in this frame, all of them."""

    ob: bpy.types.Object
    strands: Strands
    materials: list[bpy.types.Material | None]


class ChildrenUnbinding:
    """Raises RefusalError for live children that cannot become curves; nothing has changed then."""

    def __init__(self, children: Sequence[bpy.types.Object]) -> None:
        self._children, self._curves = list(children), list[_Curves]()

    def compute(self, context: bpy.types.Context) -> Pieces:
        """Blender evaluates one object after the other, and cannot be cancelled within one."""
        for i, ob in enumerate(self._children):
            yield i / len(self._children)
            self._curves.append(_read(ob, context.evaluated_depsgraph_get()))

    def write(self, _depsgraph: bpy.types.Depsgraph) -> str:
        """Changes the file, and returns a report."""
        for made in self._curves:
            data = made.ob.data
            made.strands.fill(data)
            data.materials.clear()
            for material in made.materials:
                data.materials.append(material)
            made.ob.modifiers.remove(live_children.modifier_of(made.ob))
            for name in (ids.SIGNATURE, ids.CHILDREN_SETTINGS, ids.CHILDREN_GUIDES):
                if name in made.ob:
                    del made.ob[name]
        tables.remove_unread()
        names = ", ".join(made.ob.name for made in self._curves)
        return f"Live children became curves as they are in this frame: {names}"


def _read(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> _Curves:
    following.check_editable(ob)
    if ob.data.users > 1:
        raise RefusalError(f"{ob.name} shares its data: make it a single user first")
    attributes.check_names(ob, ROOT_KINDS | {ids.SURFACE_UV: "FLOAT2"}, "CURVE")
    surface, table = live_children.surface_of(ob), live_children.table_of(ob)
    count = live_children.count_of(ob)
    modifier = live_children.modifier_of(ob)
    assert modifier is not None
    name = modifier.name

    def show_all(copy: bpy.types.Object, _scene: bpy.types.Scene) -> None:
        for other in list(copy.modifiers):
            if other.name != name:
                copy.modifiers.remove(other)
        groups.set_input(copy.modifiers[name], nodes.SHARE, 1.0)

    with cage.evaluated_copy(ob, len(ob.modifiers), depsgraph, show_all) as evaluated:
        shown = evaluated.data
        if surface is None or table is None or not count or len(shown.curves) != count:
            raise RefusalError(
                f"{ob.name} grows no strands that could become curves: run Rebind to Limit Surface "
                "first, or delete it"
            )
        position, radius = (attributes.read(shown, kind) for kind in (ids.POSITION, "radius"))
        materials = [material and material.original for material in shown.materials]
    u, v, face = attributes.read(table.data, ids.POSITION).T
    at = Locations(face.astype(np.int32), np.stack([u, v], axis=1))
    posed = PosedSurface(cage.read(surface, depsgraph))
    strands = Strands(
        Binding.at(posed, at, transform.world_matrix(ob)),
        np.full(count, len(position) // count, np.int32),
        position,
        radius,
        posed.cage.surface_uv(posed.in_object, at.face, at.uv.astype(np.float64)),
        posed.cage.uv_map.name if posed.cage.uv_map else "",
    )
    return _Curves(ob, strands, materials)
