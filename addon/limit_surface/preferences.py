# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's entry in Preferences, which shows whether its native module works."""

import textwrap

import bpy

from . import native


class LimitSurfacePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    def draw(self, _context: bpy.types.Context) -> None:
        if native.available():
            self.layout.label(text=f"Native module limitsurf {native.version()}", icon="CHECKMARK")
        else:
            draw_unavailable(self.layout)


def draw_unavailable(layout: bpy.types.UILayout) -> None:
    """Draws the reason why nothing works, in lines that fit a sidebar."""
    box = layout.box()
    box.label(text="The native module could not be loaded", icon="ERROR")
    for line in textwrap.wrap(native.reason, 44, break_on_hyphens=False):
        box.label(text=line)


classes = (LimitSurfacePreferences,)
