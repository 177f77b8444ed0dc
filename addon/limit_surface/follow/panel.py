# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the sidebar tab about what follows the active surface."""

import textwrap

import bpy

from .. import ids, native
from ..placing.follow_state import State, Trouble
from . import stale

_WIDTH = 36  # characters on a line of the sidebar


class VIEW3D_PT_limit_follow(bpy.types.Panel):
    bl_idname = ids.FOLLOW_PANEL
    bl_label = "Follow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = ids.TAB
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        state = State.of(context.active_object)
        if state is None:
            layout.label(text="Nothing follows the active object", icon="INFO")
        else:
            _draw_state(layout, state)
            for trouble in stale.troubles(context, state):
                _draw_trouble(layout, trouble)
        column = layout.column()
        column.enabled = native.available()
        for operator in (ids.FOLLOW, ids.REBIND, ids.UNBIND):
            column.operator(operator)


def _draw_state(layout: bpy.types.UILayout, state: State) -> None:
    column = layout.column(align=True)
    column.label(text=state.surface.name, icon="OBJECT_DATA")
    objects = len(state.followers)
    noun = "object follows" if objects == 1 else "objects follow"
    column.label(text=f"{objects:,} {noun} it by nodes")
    column.label(text=f"{state.places:,} strands and points")
    column.label(text=f"Tables: {_size(state.table_bytes)}")


def _draw_trouble(layout: bpy.types.UILayout, trouble: Trouble) -> None:
    box = layout.box()
    column = box.column(align=True)
    column.alert = True
    for i, line in enumerate(textwrap.wrap(trouble.text, _WIDTH)):
        column.label(text=line, icon="BLANK1" if i else "ERROR")
    row = box.row()
    row.enabled = native.available()
    row.operator(trouble.remedy)


def _size(count: int) -> str:
    power = min(max(len(str(count)) - 1, 0) // 3, 3)
    return f"{count / 1000**power:.3g} {('bytes', 'kB', 'MB', 'GB')[power]}"
