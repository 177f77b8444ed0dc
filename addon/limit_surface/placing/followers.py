# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that follow a surface: where they store their locations, and their modifiers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..nodes import follow, groups
from ..nodes.follow import SURFACE, TILES
from ..nodes.follow_curve import FOLLOW_CURVE, POINTS
from ..nodes.groups import Kind
from ..reading import attributes, overrides
from ..reading.users import objects_using, own_objects_using
from .places import lacking, root_attributes

_GROUPS = (
    ids.FOLLOW_HAIR_GROUP,
    ids.FOLLOW_BEZIER_GROUP,
    ids.FOLLOW_POINTS_GROUP,
    ids.FOLLOW_ORIENTED_GROUP,
    ids.FOLLOW_NORMALS_GROUP,
    ids.FOLLOW_CURVE_GROUP,
)
_FOLLOWING = (*_GROUPS, ids.FOLLOW_LIVE_GROUP, ids.CHILDREN_GROUP)
_ELEMENTS = {
    "CURVES": "Strand",
    "MESH": "Vertex",
    "POINTCLOUD": "Point",
    "CURVE": "Control point",
}
_BEZIER = 2  # the value of the attribute curve_type for such strands


def holder_of(ob: bpy.types.Object) -> bpy.types.ID | None:
    """Returns the data that stores the locations: the object's own, or for a Curve object, whose
    data has no attributes, the mesh of its table.
    """
    if ob.type in ("CURVES", "MESH", "POINTCLOUD"):
        return ob.data
    table = curve_table(ob) if ob.type == "CURVE" else None
    return table.data if table else None


def holders(objects: Iterable[bpy.types.Object]) -> list[bpy.types.ID]:
    """Returns the data that stores the objects' locations, each once."""
    return list(dict.fromkeys(holder for ob in objects if (holder := holder_of(ob)) is not None))


def is_own(ob: bpy.types.Object) -> bool:
    """Tells whether this file stores the locations of an object and how it follows. Those of linked
    data and of library overrides belong to the file that they come from: Blender saves no change of
    them.
    """
    holder = holder_of(ob)
    if holder is not None and (holder.library or holder.override_library):
        return False
    return not any(
        overrides.is_of_library(modifier)
        for name in _FOLLOWING
        for modifier in groups.modifiers(ob, name)
    )


def curve_table(ob: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the table of a Curve object that follows a surface."""
    modifier = next(groups.modifiers(ob, ids.FOLLOW_CURVE_GROUP), None)
    return groups.get_input(modifier, POINTS) if modifier else None


def domain_of(ob: bpy.types.Object) -> str:
    """Returns the domain on which the object's locations are stored."""
    return "CURVE" if ob.type == "CURVES" else "POINT"


def element_called(ob: bpy.types.Object, row: int) -> str:
    """Returns what one of the object's strands or points is called in messages."""
    return f"{_ELEMENTS[ob.type]} {row} of {ob.name}"


def is_placed(ob: bpy.types.Object) -> bool:
    """Tells whether locations on a surface are stored for the object."""
    holder = holder_of(ob)
    return holder is not None and not lacking(holder, root_attributes(holder))


def has_own_places(ob: bpy.types.Object) -> bool:
    """Tells whether the object's points, and not its origin, have places on a surface: hair,
    points, decals, limit meshes and drawings, whether they follow or not, and whatever follows.
    """
    is_drawing = ob.type == "CURVE" and ids.FACE in ob.data
    return is_drawing or is_placed(ob) or bool(modifier_of(ob) or live_modifier_of(ob))


def check_placed(hair: bpy.types.Object) -> None:
    """Raises RefusalError for hair that does not stand on a surface."""
    if reason := why_not_placed(hair):
        raise RefusalError(reason)


def why_not_placed(hair: bpy.types.Object) -> str:
    """Returns the reason why hair does not stand on a surface, with a remedy; nothing where it
    does.
    """
    if not is_placed(hair):
        return (
            f"{hair.name} stores no places on a limit surface: run Follow Limit Surface or Snap to "
            "Limit Surface on it first"
        )
    if surface_of(hair) is None:
        return (
            f"The surface of {hair.name} was deleted: select the hair and then another mesh, and "
            "run Snap to Limit Surface"
        )
    return ""


def modifier_of(ob: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """Returns the modifier by which the object follows a surface, if it does."""
    for modifier in ob.modifiers:
        if modifier.type == "NODES" and groups.name_of(modifier.node_group) in _GROUPS:
            return modifier
    return None


def live_modifier_of(ob: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """Returns the modifier that marks an object which follows a surface live, if it does."""
    return next(groups.modifiers(ob, ids.FOLLOW_LIVE_GROUP), None)


def followed_surface(ob: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the surface that the object follows, by nodes or live, if it does."""
    modifier = modifier_of(ob) or live_modifier_of(ob)
    return groups.get_input(modifier, SURFACE) if modifier else None


def surface_of(ob: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the surface on which the object's things stand: that which it follows, or where it
    follows none, or is astray, the one that it belongs to.
    """
    followed = followed_surface(ob)
    return followed if followed and not is_astray(ob) else own_surface_of(ob)


def own_surface_of(ob: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the surface that the object belongs to: hair's own surface, or a parent that is a
    mesh.
    """
    if ob.type == "CURVES" and ob.data.surface:
        return ob.data.surface
    return _mesh_parent(ob)


def _mesh_parent(ob: bpy.types.Object) -> bpy.types.Object | None:
    return ob.parent if ob.parent and ob.parent.type == "MESH" else None


def is_astray(ob: bpy.types.Object) -> bool:
    """Tells whether the object's modifier names another surface than the one that the object
    belongs to: its modifiers were copied from another object, or its surface was changed by hand.
    What this file does not store cannot be put right in it, and is taken at its word.
    """
    followed, own = followed_surface(ob), own_surface_of(ob)
    if followed is None or own is None or own == followed or not is_own(ob):
        return False
    if ob.type == "CURVES":
        return ob.data.surface is not None and not _is_duplicate(ob, followed)
    if ids.CARRIER_MARK in own:
        return False
    return ob.type == "CURVE" or _belonged_to_parent(ob)


def _is_duplicate(hair: bpy.types.Object, followed: bpy.types.Object) -> bool:
    """Tells whether hair that follows a linked duplicate of its surface has the data of the
    original hair, or a copy of them: they name the original surface.
    """
    parent, named = _mesh_parent(hair), hair.data.surface
    if parent is None:
        return any(followed_surface(other) == named for other in sharers(hair))
    return parent == followed and hair.data.get(ids.SURFACE_NAME, named.name) == named.name


def _belonged_to_parent(ob: bpy.types.Object) -> bool:
    """Tells whether points were placed on their parent, or were bound to it. Other meshes may have
    any mesh as their parent.
    """
    is_bound = ids.SIGNATURE in ob.data
    return is_placed(ob) and (not is_bound or bool(ob.data.get(ids.SURFACE_NAME)))


def note_surface(things: Iterable[bpy.types.Object], surface: bpy.types.Object) -> None:
    """Stores which surface things belong to that are bound to one."""
    for ob in things:
        if ob.type == "CURVES":
            ob.data[ids.SURFACE_NAME] = (ob.data.surface or surface).name
        elif ob.type != "CURVE":  # a curve can only be bound to its parent, if that is a mesh
            ob.data[ids.SURFACE_NAME] = surface.name if ob.parent == surface else ""


def why_astray(ob: bpy.types.Object) -> str:
    """Returns what is wrong with an object that is astray; nothing for any other."""
    followed, own = followed_surface(ob), own_surface_of(ob)
    if followed is None or own is None or not is_astray(ob):
        return ""
    names_it = "Object Data > Surface" if ob.type == "CURVES" else "its parent"
    modifier = modifier_of(ob) or live_modifier_of(ob)
    assert modifier is not None
    return (
        f"{ob.name} belongs to {own.name} ({names_it}), but its modifier {modifier.name} names the "
        f"surface {followed.name} instead"
    )


def check_not_astray(ob: bpy.types.Object) -> None:
    """Raises RefusalError for an object that is shown on another surface than its own."""
    if reason := why_astray(ob):
        raise RefusalError(f"{reason}: run Follow Limit Surface on it first")


def sharers(ob: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the other objects that have the same data."""
    if ob.data is None or ob.data.users < 2:
        return []
    return [other for other in users_of(ob.data) if other != ob]


def users_of(data: bpy.types.ID) -> list[bpy.types.Object]:
    """Returns the objects whose data this is."""
    return [ob for ob in objects_using(data) if ob.data == data]


def ground_of(ob: bpy.types.Object | None) -> bpy.types.Object | None:
    """Returns the mesh that the object is, or on which it stands where it is hair or points."""
    if ob is None or not (ob.type == "CURVES" or _is_points(ob)):
        return ob if ob is not None and ob.type == "MESH" else None
    surface = surface_of(ob)
    return surface if surface is not None and surface.type == "MESH" else None


def _is_points(ob: bpy.types.Object) -> bool:
    return ob.type == "MESH" and not ob.data.polygons and is_placed(ob)


def followers_of(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the file's own objects that follow a surface by nodes."""
    return [ob for ob in own_objects_using(surface) if _follows(ob, modifier_of(ob), surface)]


def own_followers_of(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns those of them whose locations this file stores, so that they can be bound again."""
    return [ob for ob in followers_of(surface) if is_own(ob)]


def live_followers_of(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the file's own objects that follow a surface live."""
    return [ob for ob in own_objects_using(surface) if _follows(ob, live_modifier_of(ob), surface)]


def _follows(
    ob: bpy.types.Object, modifier: bpy.types.NodesModifier | None, surface: bpy.types.Object
) -> bool:
    is_its = modifier is not None and groups.get_input(modifier, SURFACE) == surface
    return is_its and not is_astray(ob)


def anything_follows() -> bool:
    """Tells whether the file has a node group by which something follows a surface. It is far
    quicker than a look at all objects, so panels ask it first.
    """
    return any(groups.name_of(group) in _FOLLOWING for group in bpy.data.node_groups)


def strays_of(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the file's own objects that were bound to a surface and have lost their modifier."""
    return [ob for ob in own_objects_using(surface) if is_stray(ob) and surface_of(ob) == surface]


def is_stray(ob: bpy.types.Object) -> bool:
    """Tells whether the object was bound by nodes, and has lost its modifier."""
    return was_bound(ob) and modifier_of(ob) is None and live_modifier_of(ob) is None


def astray_from(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the file's own objects that belong to a surface, and whose modifiers name another."""
    return [
        ob for ob in own_objects_using(surface) if own_surface_of(ob) == surface and is_astray(ob)
    ]


def bound_to(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the file's own objects that follow a surface in whatever way, or should."""
    return [
        *followers_of(surface),
        *live_followers_of(surface),
        *strays_of(surface),
        *astray_from(surface),
    ]


def own_or_all(things: Sequence[bpy.types.Object]) -> list[bpy.types.Object]:
    """Returns those of the things that this file can bind. Where there are none, it returns all, so
    that a refusal names them.
    """
    return [ob for ob in things if is_own(ob)] or list(things)


def was_bound(ob: bpy.types.Object) -> bool:
    """Tells whether the object follows a surface, or did and has lost its modifier."""
    return bool(modifier_of(ob)) or (_has_tiles(ob) and is_placed(ob))


def _has_tiles(ob: bpy.types.Object) -> bool:
    holder = holder_of(ob)
    return holder is not None and ids.TILE in holder.attributes


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


def _kind(ob: bpy.types.Object) -> Kind:
    if ob.type == "CURVE":
        return FOLLOW_CURVE
    if ob.type == "CURVES":
        return follow.FOLLOW_BEZIER if _has_bezier_strands(ob.data) else follow.FOLLOW_HAIR
    stored = ob.data.attributes
    if ids.ROTATION in stored:
        return follow.FOLLOW_ORIENTED
    if ids.CUSTOM_NORMAL in stored and stored[ids.CUSTOM_NORMAL].data_type == "FLOAT_VECTOR":
        return follow.FOLLOW_NORMALS
    return follow.FOLLOW_POINTS


def _has_bezier_strands(data: bpy.types.Curves) -> bool:
    if ids.CURVE_TYPE not in data.attributes:
        return False
    return bool(np.any(attributes.read(data, ids.CURVE_TYPE) == _BEZIER))
