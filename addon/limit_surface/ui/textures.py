# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the sidebar tab for textures and meshes that are made from the surface."""

import bpy

from .. import ids, native

#: The operators in the order of the panel and of the menu
ENTRIES = (
    (ids.PROJECT_IMAGE, "MOD_UVPROJECT"),
    (ids.BAKE_MAPS, "IMAGE_DATA"),
    (ids.BAKE_DISPLACEMENT, "MOD_DISPLACE"),
    (ids.CURVATURE, "SPHERECURVE"),
    (ids.LIMIT_MESH, "MOD_SUBSURF"),
)


class VIEW3D_PT_limit_textures(bpy.types.Panel):
    bl_idname = ids.TEXTURES_PANEL
    bl_label = "Textures and Meshes"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = ids.TAB
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        column = self.layout.column()
        column.enabled = native.available()
        draw_entries(column)


def draw_entries(layout: bpy.types.UILayout) -> None:
    for operator, icon in ENTRIES:
        layout.operator(operator, icon=icon)
