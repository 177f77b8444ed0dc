# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether what stands on a surface still fits it."""

from collections.abc import Sequence

import bpy

from .. import ids
from ..errors import RefusalError
from ..nodes import groups
from ..nodes.follow import TILES
from ..placing import followers, following, tables
from ..reading import attributes, cage


def check(objects: Sequence[bpy.types.Object]) -> None:
    """Raises RefusalError for the first object whose binding is stale in the current frame."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    cages: dict[bpy.types.Object, cage.Cage] = {}
    for ob in objects:
        holder = followers.holder_of(ob)
        surface = followers.surface_of(ob)
        if holder is None or surface is None or not followers.is_placed(ob):
            continue
        if surface not in cages:
            cages[surface] = cage.read(surface, depsgraph)
        now = following.signature(cages[surface])
        following.check_holds(ob, surface, now)
        _check_faces(ob, holder, surface, cages[surface].ptex_face_count)
        _check_tables(ob, surface, now)


def _check_faces(
    ob: bpy.types.Object, holder: bpy.types.ID, surface: bpy.types.Object, count: int
) -> None:
    face = attributes.read(holder, ids.FACE)
    strays = int((face >= count).sum())
    if strays:
        raise RefusalError(
            f"{strays:,} of the {len(face):,} roots of {ob.name} are bound to faces that "
            f"{surface.name} does not have: its topology has changed since they were placed"
        )


def _check_tables(ob: bpy.types.Object, surface: bpy.types.Object, now: str) -> None:
    modifier = followers.modifier_of(ob)
    if modifier is None:
        return
    table = groups.get_input(modifier, TILES)
    if table is None or tables.surface_of(table) is None or tables.points_of(table) is None:
        raise RefusalError(
            f"{ob.name} follows {surface.name} by tables that have been deleted: bind it again"
        )
    if table.get(ids.SIGNATURE) != now:
        raise RefusalError(
            f"the topology, the creases or the rules of {surface.name} have changed since "
            f"{ob.name} was bound to it: rebind it"
        )
