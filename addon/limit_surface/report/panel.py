# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the sidebar tab that shows the last report on the active mesh."""

import bpy

from .. import ids, native
from . import text


class VIEW3D_PT_limit_report(bpy.types.Panel):
    bl_idname = ids.REPORT_PANEL
    bl_label = "Distance of the Displayed Mesh"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = ids.TAB
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        column = layout.column()
        column.enabled = native.available()
        column.operator(ids.SHOW, icon="HIDE_OFF")
        column.operator(ids.REPORT_OPERATOR, icon="DRIVER_DISTANCE")
        ob = context.active_object
        if ob is None or ids.REPORT not in ob:
            return
        layout.label(text="At the last report, in world units:")
        for name, kept in ob[ids.REPORT].items():
            box = layout.box().column(align=True)
            box.label(text=f"{text.MESHES[name]}, level {kept['level']}")
            for title, *values in text.rows(kept):
                line = box.split(factor=0.46)
                line.label(text=title)
                columns = line.row()
                for value in values:
                    columns.label(text=value)
