# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of Curve objects that copies of the objects read as well.

Blender copies a Curve object without its hidden table. As long as both stand on one surface they
may share it. A copy that follows a copy of the surface needs a table of its own before anything is
written to it.
"""

from __future__ import annotations

from collections.abc import Iterable

import bpy

from .. import ids
from ..nodes import groups
from ..nodes.follow_curve import POINTS
from . import tables
from .followers import curve_table


def separate(things: Iterable[bpy.types.Object]) -> None:
    """Gives those of the things that are Curve objects tables that nothing else reads."""
    read: dict[bpy.types.Object, list[bpy.types.Object]] = {}
    for ob in things:
        table = curve_table(ob) if ob.type == "CURVE" else None
        if table is not None:
            read.setdefault(table, []).append(ob)
    for table, curves in read.items():
        if set(tables.readers(table)).issubset(curves):
            continue
        own = tables.copy_of(table, ids.CURVE_TABLE, curves[0])
        for ob in curves:
            for modifier in groups.modifiers(ob, ids.FOLLOW_CURVE_GROUP):
                groups.set_input(modifier, POINTS, own)
