# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's own menus: Add > Curve, Object > Limit Surface, and the Snap menus."""

import bpy

from .. import ids
from .textures import draw_entries


class VIEW3D_MT_object_limit_surface(bpy.types.Menu):
    bl_idname = ids.OBJECT_MENU
    bl_label = "Limit Surface"

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.operator(ids.HAIR_ADD, icon="CURVES")
        self.layout.operator(ids.POINTS_ADD, icon="POINTCLOUD_DATA")
        self.layout.operator(ids.CHILDREN_ADD, icon="PARTICLEMODE")
        self.layout.operator(ids.SNAP, icon="SNAP_ON")
        self.layout.operator(ids.SNAP_MODAL, icon="VIEW_PAN")
        self.layout.operator(ids.DRAW, icon="GREASEPENCIL")
        self.layout.operator(ids.CURVE_LAY, icon="MOD_SHRINKWRAP")
        self.layout.operator(ids.SHOW, icon="HIDE_OFF")
        self.layout.operator(ids.REPORT_OPERATOR, icon="DRIVER_DISTANCE")
        self.layout.operator(ids.ATTACH, icon="LINKED")
        self.layout.operator(ids.PARTICLES_FROM_HAIR, icon="PARTICLES")
        self.layout.operator(ids.HAIR_FROM_PARTICLES, icon="CURVES")
        self.layout.operator(ids.SAMPLE_TABLES, icon="NODETREE")
        self.layout.operator(ids.SAMPLE_REMOVE, icon="TRASH")
        self.layout.separator()
        self.layout.operator(ids.FOLLOW, icon="MOD_SIMPLEDEFORM")
        self.layout.operator(ids.REBIND, icon="FILE_REFRESH")
        self.layout.operator(ids.UNBIND, icon="UNLINKED")
        self.layout.separator()
        draw_entries(self.layout)


def _draw_in_add_curve(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator(ids.HAIR_ADD, text="Hair on Limit Surface", icon="CURVES")
    self.layout.operator(ids.DRAW, icon="GREASEPENCIL")


def _draw_in_object(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.menu(ids.OBJECT_MENU)


def _draw_in_snap(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator(ids.SNAP, text="Selection to Limit Surface")
    self.layout.operator(ids.SNAP_MODAL)


def _draw_in_add_node(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    if context.space_data.tree_type == "GeometryNodeTree":
        self.layout.separator()
        self.layout.operator(ids.SAMPLE_ADD)


_ENTRIES = (
    (bpy.types.VIEW3D_MT_curve_add, _draw_in_add_curve),
    (bpy.types.VIEW3D_MT_object, _draw_in_object),
    (bpy.types.VIEW3D_MT_snap, _draw_in_snap),
    (bpy.types.NODE_MT_add, _draw_in_add_node),
    (bpy.types.VIEW3D_MT_edit_curves, _draw_in_snap),
    (bpy.types.VIEW3D_MT_sculpt_curves, _draw_in_snap),
)


def append_menus() -> None:
    for menu, draw in _ENTRIES:
        menu.append(draw)


def remove_menus() -> None:
    for menu, draw in _ENTRIES:
        menu.remove(draw)
