# SPDX-License-Identifier: GPL-3.0-or-later
"""The main panel of the sidebar tab Limit: the active surface at a glance, and the operators that
place things on it.
"""

import bpy

from .. import ids, native
from ..placing import live_children
from ..placing.followers import (
    anything_follows,
    followers_of,
    ground_of,
    live_followers_of,
)
from ..preferences import draw_unavailable
from ..reading import rules
from ..subsurf import shown


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
        surface = ground_of(context.active_object)
        if surface is None:
            layout.label(text="No active mesh", icon="INFO")
        else:
            layout.label(text=surface.name, icon="OBJECT_DATA")
            _draw_rules(layout, surface)
            _draw_shown(layout, surface, context.scene)
            _draw_bound(layout, surface)
        column = layout.column()
        column.enabled = native.available()
        column.operator(ids.HAIR_ADD, icon="CURVES")
        column.operator(ids.POINTS_ADD, icon="POINTCLOUD_DATA")
        column.operator(ids.DRAW, icon="GREASEPENCIL")


def _draw_rules(layout: bpy.types.UILayout, surface: bpy.types.Object) -> None:
    subsurf = rules.find_subsurf(surface)
    if subsurf is None:
        layout.label(text="No Subdivision Surface", icon="MOD_SUBSURF")
        return
    layout.label(text=subsurf.name, icon="MOD_SUBSURF")
    column = layout.column(align=True)
    column.use_property_split, column.use_property_decorate = True, False
    if subsurf.subdivision_type == "SIMPLE":
        column.label(text="Simple: bilinear faces")
        return
    column.prop(subsurf, "boundary_smooth", text="Boundary")
    column.prop(subsurf, "uv_smooth")
    column.prop(subsurf, "use_creases")


def _draw_shown(
    layout: bpy.types.UILayout, surface: bpy.types.Object, scene: bpy.types.Scene
) -> None:
    """Draws whether the viewport shows the limit surface, and offers to show it."""
    found = shown.of(surface, scene)
    row = layout.row()
    row.alert = found.is_far
    row.label(text=found.text, icon="ERROR" if found.is_far else "HIDE_OFF")
    if not found.is_limit:
        row = layout.row()
        row.enabled = native.available()
        row.operator(ids.SHOW, icon="HIDE_OFF")


def _draw_bound(layout: bpy.types.UILayout, surface: bpy.types.Object) -> None:
    """Draws how much follows the surface. The header of the panel Follow says what is stale."""
    count = 0
    if anything_follows():
        count = len(followers_of(surface)) + len(live_followers_of(surface))
        count += len(live_children.on_surface(surface))
    noun = "object follows" if count == 1 else "objects follow"
    layout.label(text=f"{count:,} {noun} it" if count else "Nothing follows it", icon="LINKED")
