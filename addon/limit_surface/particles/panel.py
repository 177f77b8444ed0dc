# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the sidebar tab with which hair becomes particles, and particles become hair."""

import bpy

from .. import ids, native


class VIEW3D_PT_limit_particles(bpy.types.Panel):
    bl_idname = ids.PARTICLES_PANEL
    bl_label = "Particles"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = ids.TAB
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        column = self.layout.column()
        column.enabled = native.available()
        column.operator(ids.PARTICLES_FROM_HAIR, icon="PARTICLES")
        column.operator(ids.HAIR_FROM_PARTICLES, icon="CURVES")
