# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that the operators of following work on."""

import bpy

from ..placing.followers import followers_of, modifier_of


def selected(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Returns the selected objects and the active one, each once."""
    chosen = dict.fromkeys([*context.selected_objects, context.active_object])
    return [ob for ob in chosen if ob is not None]


def chosen_followers(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Returns the selected objects that follow a surface, or where there are none, all that follow
    the active mesh.
    """
    found = [ob for ob in selected(context) if modifier_of(ob)]
    active = context.active_object
    if not found and active is not None and active.type == "MESH":
        found = followers_of(active)
    return found
