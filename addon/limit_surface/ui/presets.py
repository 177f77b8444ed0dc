# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the operators that place things, by Blender's own preset menus.

The redo panel shows them by itself. The panels with the settings of the next run have a menu of the
same presets, the shipped ones and the user's own: a preset sets properties of "the active
operator", for which these settings stand in here.
"""

from pathlib import Path

import bpy
from bl_ui.utils import PresetPanel

from .. import ids

_EXTENSION = str(Path(__file__).resolve().parents[1])  # its folder `presets` holds those shipped


class _NextRunPresets(PresetPanel):
    """Mixin for menus with the presets for the next run of an operator."""

    bl_label = "Presets"
    preset_operator = "script.execute_preset"
    preset_add_operator = "wm.operator_preset_add"
    operator = ""

    @property
    def preset_subdir(self) -> str:
        return f"operator/{self.operator}"

    @property
    def preset_add_operator_properties(self) -> dict[str, str]:
        area, name = self.operator.split(".")
        return {"operator": f"{area.upper()}_OT_{name}"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.window_manager.operator_properties_last(self.operator)
        self.layout.context_pointer_set("active_operator", settings)
        PresetPanel.draw(self, context)


class VIEW3D_PT_limit_hair_presets(_NextRunPresets, bpy.types.Panel):
    bl_idname = ids.HAIR_PRESETS
    operator = ids.HAIR_ADD


class VIEW3D_PT_limit_points_presets(_NextRunPresets, bpy.types.Panel):
    bl_idname = ids.POINTS_PRESETS
    operator = ids.POINTS_ADD


def attach_presets() -> None:
    bpy.utils.register_preset_path(_EXTENSION)


def detach_presets() -> None:
    bpy.utils.unregister_preset_path(_EXTENSION)
