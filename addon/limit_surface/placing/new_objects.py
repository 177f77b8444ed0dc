# SPDX-License-Identifier: GPL-3.0-or-later
"""New objects that belong to a surface."""

import bpy

from ..errors import RefusalError


def add_on_surface(
    context: bpy.types.Context, name: str, data: bpy.types.ID, surface: bpy.types.Object
) -> bpy.types.Object:
    """An object that shares the surface's transform, active and alone selected."""
    ob = bpy.data.objects.new(name, data)
    ob.parent = surface
    _collection(context).objects.link(ob)
    if context.space_data and getattr(context.space_data, "local_view", None):
        ob.local_view_set(context.space_data, True)
    for other in context.selected_objects:
        other.select_set(False)
    ob.select_set(True)
    context.view_layer.objects.active = ob
    context.view_layer.update()
    return ob


def key(ob: bpy.types.Object) -> tuple[str, str | None]:
    """By which `find` tells it from those of the same name in other files."""
    return ob.name, ob.library.filepath if ob.library else None


def find(known: tuple[str, str | None]) -> bpy.types.Object:
    """RefusalError if it has been removed."""
    ob = bpy.data.objects.get(known)
    if ob is None:
        raise RefusalError(f"{known[0]} is not there any more")
    return ob


def _collection(context: bpy.types.Context) -> bpy.types.Collection:
    """The active collection, or the scene's own where that one takes or shows no objects."""
    active = context.view_layer.active_layer_collection
    if active.is_visible and active.collection.is_editable:
        return active.collection
    return context.scene.collection
