# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapped things follow the surface on which they are now: those that follow one already, and hair
that is to follow.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from .. import ids, native
from ..nodes import groups
from ..nodes.follow import SURFACE
from ..placing import curve_points, following, live_attributes, live_binding
from ..placing.follow_properties import follows
from ..placing.followers import live_modifier_of, modifier_of


def bind_again(
    objects: Sequence[bpy.types.Object],
    target: bpy.types.Object,
    context: bpy.types.Context,
    follow: str = "NONE",
) -> list[str]:
    """Binds those of the objects that follow a surface to the target. Hair that follows none yet
    begins to by the value of the property `follow`. Returns warnings about those for which that is
    impossible.
    """
    hair = [ob for ob in objects if ob.type == "CURVES"]
    live = [ob for ob in hair if live_modifier_of(ob)]
    by_nodes = [ob for ob in hair if modifier_of(ob)]
    others = [ob for ob in hair if ob not in live and ob not in by_nodes]
    if follow == "LIVE":
        live += others
    elif follows(follow, target):
        by_nodes += others
    for ob in (*live, *by_nodes):
        _change_surface(ob, target)
    try:
        if live:
            depsgraph = context.evaluated_depsgraph_get()
            live_binding.LiveRequest(target, depsgraph, live).write(context)
        if by_nodes:
            depsgraph = context.evaluated_depsgraph_get()
            following.Request(target, depsgraph, by_nodes).compute().write()
        for ob in objects:
            if ob.type == "CURVE" and modifier_of(ob):
                curve_points.bind([ob], target, context)
    except native.refusals as error:
        reason = native.sentence(error)
        return [f"What was snapped does not follow {target.name} properly now: {reason}"]
    return []


def will_follow(ob: bpy.types.Object, target: bpy.types.Object, follow: str) -> bool:
    """Tells whether hair follows the target once it is bound again."""
    follows_already = live_modifier_of(ob) or modifier_of(ob)
    return bool(follows_already) or follow == "LIVE" or follows(follow, target)


def _change_surface(ob: bpy.types.Object, target: bpy.types.Object) -> None:
    """Makes hair that follows another surface follow the target. Its strands are at rest there as
    they are now.
    """
    modifier = modifier_of(ob) or live_modifier_of(ob)
    if modifier and groups.get_input(modifier, SURFACE) != target:
        groups.set_input(modifier, SURFACE, target)
        ob.data.pop(ids.SIGNATURE, None)
        live_attributes.leave(ob.data)
