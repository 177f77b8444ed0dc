# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapped things that follow a surface get the tiles of their new places."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from .. import ids
from ..errors import RefusalError
from ..nodes import groups
from ..nodes.follow import SURFACE
from ..placing import curve_points, following
from ..placing.followers import modifier_of


def bind_again(
    objects: Sequence[bpy.types.Object], target: bpy.types.Object, context: bpy.types.Context
) -> list[str]:
    """Binds those of the objects that follow a surface to the target, and returns warnings about
    those for which that is impossible.
    """
    moved = [ob for ob in objects if modifier_of(ob)]
    hair = [ob for ob in moved if ob.type == "CURVES"]
    for ob in hair:
        modifier = modifier_of(ob)
        if modifier and groups.get_input(modifier, SURFACE) != target:
            groups.set_input(modifier, SURFACE, target)
            ob.data.pop(ids.SIGNATURE, None)
    try:
        if hair:
            depsgraph = context.evaluated_depsgraph_get()
            following.Request(target, depsgraph, hair).compute().write()
        for ob in moved:
            if ob.type == "CURVE":
                curve_points.bind([ob], target, context)
    except RefusalError as error:
        return [f"What was snapped does not follow {target.name} properly now: {error}"]
    return []
