# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the sidebar tab with the settings for the next strands or points, and their expected
number.
"""

from typing import Any, ClassVar

import bpy

from .. import ids, native
from ..placing import distribution_properties, live_count
from ..placing.followers import ground_of
from ..tasks import wrapped_text
from .presets import VIEW3D_PT_limit_hair_presets, VIEW3D_PT_limit_points_presets


def class_of(operator: str) -> Any:
    """Returns the class of an operator, which Blender knows by another name."""
    area, name = operator.split(".")
    return getattr(bpy.types, f"{area.upper()}_OT_{name}")


class _DistributionPanel:
    """Mixin for panels with the settings that a menu or button will pass to an operator."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = ids.TAB
    bl_parent_id = ids.PANEL
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}
    operator = ""
    presets: type[bpy.types.Panel]
    noun = ""
    layout: bpy.types.UILayout

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        is_here = native.available() and context.mode == "OBJECT"
        return is_here and ground_of(context.active_object) is not None

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        self.presets.draw_menu(layout)
        layout.use_property_split = True
        settings = context.window_manager.operator_properties_last(self.operator)
        distribution_properties.draw(layout, settings, context)
        class_of(self.operator).draw_own(layout, settings)
        layout.prop(settings, "follow")
        wrapped_text.draw(layout, live_count.text(context, settings, self.noun), "INFO")
        layout.operator(self.operator)


class VIEW3D_PT_limit_hair(_DistributionPanel, bpy.types.Panel):
    bl_idname = ids.HAIR_PANEL
    bl_label = "Hair"
    operator = ids.HAIR_ADD
    presets = VIEW3D_PT_limit_hair_presets
    noun = "strands"


class VIEW3D_PT_limit_points(_DistributionPanel, bpy.types.Panel):
    bl_idname = ids.POINTS_PANEL
    bl_label = "Points"
    operator = ids.POINTS_ADD
    presets = VIEW3D_PT_limit_points_presets
    noun = "points"
