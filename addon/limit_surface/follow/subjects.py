# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that the operators of following work on."""

from collections.abc import Iterable

import bpy

from ..errors import RefusalError
from ..placing import live_children
from ..placing.followers import (
    bound_to,
    followers_of,
    is_own,
    is_placed,
    live_followers_of,
    live_modifier_of,
    modifier_of,
    own_or_all,
    strays_of,
    surface_of,
    was_bound,
)
from ..placing.relocation import TYPES
from ..placing.unbinding import leftovers_of
from ..reading.users import own_objects_using

BINDABLE = (*TYPES, "CURVE")


def selected(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Returns the selected objects and the active one, each once."""
    chosen = dict.fromkeys([*context.selected_objects, context.active_object])
    return [ob for ob in chosen if ob is not None]


def chosen_followers(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Returns the selected objects that follow a surface, or have lost the modifier by which they
    did; where there are none, all such objects of the active mesh.
    """
    chosen = selected(context)
    found = [ob for ob in chosen if was_bound(ob) or live_modifier_of(ob)]
    active = context.active_object
    if any(live_children.modifier_of(ob) for ob in chosen):
        return found
    if not found and active is not None and active.type == "MESH":
        found = [ob for ob in _unbound_with(active) if not live_children.modifier_of(ob)]
    return found


def _unbound_with(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns what is unbound with a surface on which nothing else is selected. Library overrides
    are among it only if there is nothing else to be done, so that the refusal names them.
    """
    everything = [
        *followers_of(surface),
        *live_followers_of(surface),
        *strays_of(surface),
        *live_children.on_surface(surface),
    ]
    own = [ob for ob in everything if is_own(ob)]
    return own if own or not everything or leftovers_of(surface) else everything


def to_bind(
    context: bpy.types.Context,
) -> dict[bpy.types.Object, list[bpy.types.Object]]:
    """Returns the selected things by their surface. An active mesh that is no such thing itself is
    the surface of all others; where nothing else is selected, all that was bound to it is taken.
    Raises RefusalError for a thing without a surface.
    """
    active = context.active_object
    things = [ob for ob in selected(context) if ob.type in BINDABLE]
    if active is not None and active.type == "MESH" and not is_placed(active):
        things.remove(active)
        things = things or own_or_all(bound_to(active))
        return {active: things} if things else {}
    surfaces = {surface_of(ob) for ob in things}
    found: dict[bpy.types.Object, list[bpy.types.Object]] = {}
    for ob in things:
        if ob in surfaces and not is_placed(ob):
            continue
        surface = surface_of(ob)
        if surface is None and active != ob and active in things and active.type == "MESH":
            surface = active
        if surface is None:
            raise RefusalError(
                f"{ob.name} has no surface: select the mesh that it stands on as well, and make it "
                "the active object"
            )
        found.setdefault(surface, []).append(ob)
    return found


def has_to_bind(context: bpy.types.Context) -> bool:
    """Tells whether there is something to bind. Things without a surface count, because the
    operator says what they lack.
    """
    try:
        return bool(to_bind(context))
    except RefusalError:
        return True


def has_to_rebind(context: bpy.types.Context) -> bool:
    """Tells whether something is selected that stands on a surface, or a mesh that something
    follows or has followed.
    """
    chosen = selected(context)
    if any(modifier_of(ob) or is_placed(ob) or live_children.modifier_of(ob) for ob in chosen):
        return True
    meshes = [ob for ob in chosen if ob.type == "MESH"]
    return any(
        was_bound(ob) or live_modifier_of(ob) or live_children.modifier_of(ob)
        for ob in own_objects_using(*meshes)
    )


def to_rebind(
    context: bpy.types.Context,
) -> dict[bpy.types.Object, list[bpy.types.Object]]:
    """Returns the surfaces among the selected objects that something follows, and those on which
    the selected things stand, with these things.
    """
    found: dict[bpy.types.Object, list[bpy.types.Object]] = {}
    for ob in selected(context):
        surface = surface_of(ob) if modifier_of(ob) or is_placed(ob) else None
        if surface is not None:
            found.setdefault(surface, []).append(ob)
        elif ob.type == "MESH" and (bound := bound_to(ob)):
            found.setdefault(ob, own_or_all(bound))
    return found


def children_to_rebind(
    context: bpy.types.Context, surfaces: Iterable[bpy.types.Object]
) -> list[bpy.types.Object]:
    """Returns the selected live children, and all that grow on the selected meshes or on these
    surfaces.
    """
    chosen = selected(context)
    found = [ob for ob in chosen if live_children.modifier_of(ob)]
    for surface in dict.fromkeys([*surfaces, *(ob for ob in chosen if ob.type == "MESH")]):
        found += live_children.on_surface(surface)
    return list(dict.fromkeys(found))


def children_to_unbind(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Returns the selected live children, or where nothing is selected that follows, all that grow
    on the active mesh.
    """
    chosen = selected(context)
    found = [ob for ob in chosen if live_children.modifier_of(ob)]
    active = context.active_object
    follows = any(modifier_of(ob) or live_modifier_of(ob) for ob in chosen)
    if not found and not follows and active is not None and active.type == "MESH":
        found = [ob for ob in _unbound_with(active) if live_children.modifier_of(ob)]
    return found
