# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the sidebar tab with the settings for the next strokes, some of which have no effect
once the strokes are drawn.
"""

from typing import ClassVar

import bpy

from .. import ids, native
from ..placing.followers import ground_of, surface_of
from .distribution import class_of


class VIEW3D_PT_limit_draw(bpy.types.Panel):
    bl_idname = ids.DRAW_PANEL
    bl_label = "Draw"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = ids.TAB
    bl_parent_id = ids.PANEL
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        is_here = native.available() and context.mode == "OBJECT"
        return is_here and (ground_of(context.active_object) is not None or _is_drawing(context))

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        settings = context.window_manager.operator_properties_last(ids.DRAW)
        class_of(ids.DRAW).draw_next(layout, settings, not _is_drawing(context))
        layout.operator(ids.DRAW)


def _is_drawing(context: bpy.types.Context) -> bool:
    """Tells whether the active object is a curve whose strokes would be continued."""
    active = context.active_object
    return active is not None and active.type == "CURVE" and surface_of(active) is not None
