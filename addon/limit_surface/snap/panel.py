# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the sidebar tab with which users snap things and choose the target."""

import bpy

from .. import ids, native
from ..tasks import wrapped_text
from .selection import find_target


class VIEW3D_PT_limit_snap(bpy.types.Panel):
    bl_idname = ids.SNAP_PANEL
    bl_label = "Snap"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = ids.TAB
    bl_order = 1  # below the panel that shows the active mesh

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        is_object_mode = context.mode == "OBJECT"
        row = layout.row()
        row.active = not is_object_mode  # the active mesh is the target there
        row.prop(context.scene.limit_surface, "target")
        if is_object_mode:
            target = find_target(context)
            name = target.name if target is not None and target.type == "MESH" else ""
            text = (
                f"In Object Mode, the target is the active mesh: {name}"
                if name
                else "No active mesh"
            )
            wrapped_text.draw(layout, text, "INFO")
        column = layout.column()
        column.enabled = native.available()
        column.operator(ids.SNAP, icon="SNAP_ON")
        column.operator(ids.SNAP_MODAL, icon="VIEW_PAN")
