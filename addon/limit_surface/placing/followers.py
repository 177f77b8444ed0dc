# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that follow a surface: what they store, and their modifiers."""

from __future__ import annotations

import bpy

from .. import ids
from ..nodes import groups
from ..nodes.follow import FOLLOW_HAIR, FOLLOW_ORIENTED, FOLLOW_POINTS, SURFACE, TILES
from .places import ROOT_KINDS

_GROUPS = (ids.FOLLOW_HAIR_GROUP, ids.FOLLOW_POINTS_GROUP, ids.FOLLOW_ORIENTED_GROUP)


def domain_of(ob: bpy.types.Object) -> str:
    """Returns the domain on which the object's locations are stored."""
    return "CURVE" if ob.type == "CURVES" else "POINT"


def is_placed(ob: bpy.types.Object) -> bool:
    """Tells whether the object stores locations on a surface."""
    if ob.type not in ("CURVES", "MESH", "POINTCLOUD"):
        return False
    stored = ob.data.attributes
    return all(
        name in stored and (stored[name].data_type, stored[name].domain) == (kind, domain_of(ob))
        for name, kind in ROOT_KINDS.items()
    )


def modifier_of(ob: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """Returns the modifier by which the object follows a surface, if it does."""
    return next((m for name in _GROUPS for m in groups.modifiers(ob, name)), None)


def surface_of(ob: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the surface on which the object's things stand: that which it follows, hair's own
    surface, or a parent that is a mesh.
    """
    modifier = modifier_of(ob)
    if modifier and groups.get_input(modifier, SURFACE):
        return groups.get_input(modifier, SURFACE)
    if ob.type == "CURVES" and ob.data.surface:
        return ob.data.surface
    return ob.parent if ob.parent and ob.parent.type == "MESH" else None


def followers_of(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the file's own objects that follow a surface by nodes."""
    found = []
    for ob in bpy.data.objects:
        modifier = modifier_of(ob) if ob.library is None else None
        if modifier and groups.get_input(modifier, SURFACE) == surface:
            found.append(ob)
    return found


def strays_of(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the file's own objects that were bound to a surface and have lost their modifier."""
    return [
        ob
        for ob in bpy.data.objects
        if ob.library is None
        and is_placed(ob)
        and ids.TILE in ob.data.attributes
        and modifier_of(ob) is None
        and surface_of(ob) == surface
    ]


def ensure_modifier(
    ob: bpy.types.Object, surface: bpy.types.Object, table: bpy.types.Object
) -> None:
    """Gives the object the modifier by which it follows the surface."""
    kind, modifier = _kind(ob), modifier_of(ob)
    if modifier is None:
        # Other modifiers shape what follows, or put instances on it.
        modifier = groups.add_modifier(ob, kind, place=0)
    elif not kind.matches(modifier.node_group):
        modifier.node_group = kind.group()
    groups.set_input(modifier, SURFACE, surface)
    groups.set_input(modifier, TILES, table)


def _kind(ob: bpy.types.Object) -> groups.Kind:
    if ob.type == "CURVES":
        return FOLLOW_HAIR
    return FOLLOW_ORIENTED if ids.ROTATION in ob.data.attributes else FOLLOW_POINTS
