# SPDX-License-Identifier: GPL-3.0-or-later
"""The main panel of the sidebar tab Limit: the active mesh, and the operators for it."""

import bpy

from .. import ids, native
from ..preferences import draw_unavailable
from ..reading import rules


class VIEW3D_PT_limit_surface(bpy.types.Panel):
    bl_idname = ids.PANEL
    bl_label = "Limit Surface"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = ids.TAB

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        if not native.available():
            draw_unavailable(layout)
        _draw_rules(layout, context.active_object)
        column = layout.column()
        column.enabled = native.available()
        column.operator(ids.HAIR_ADD, icon="CURVES")
        column.operator(ids.POINTS_ADD, icon="POINTCLOUD_DATA")


def _draw_rules(layout: bpy.types.UILayout, ob: bpy.types.Object | None) -> None:
    if ob is None or ob.type != "MESH":
        layout.label(text="No active mesh", icon="INFO")
        return
    subsurf = rules.find_subsurf(ob)
    layout.label(text=ob.name, icon="OBJECT_DATA")
    if subsurf is None:
        layout.label(text="Rules: Subdivision's defaults", icon="MOD_SUBSURF")
        return
    layout.label(text=subsurf.name, icon="MOD_SUBSURF")
    column = layout.column(align=True)
    if subsurf.subdivision_type == "SIMPLE":
        column.label(text="Simple: bilinear faces")
        return
    column.prop(subsurf, "boundary_smooth", text="")
    column.prop(subsurf, "uv_smooth", text="")
    column.prop(subsurf, "use_creases")
