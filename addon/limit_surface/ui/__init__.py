# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab and the menu entries."""

from .distribution import VIEW3D_PT_limit_hair, VIEW3D_PT_limit_points
from .drawing import VIEW3D_PT_limit_draw
from .menus import VIEW3D_MT_object_limit_surface, append_menus, remove_menus
from .panel import VIEW3D_PT_limit_surface
from .presets import (
    VIEW3D_PT_limit_hair_presets,
    VIEW3D_PT_limit_points_presets,
    attach_presets,
    detach_presets,
)
from .textures import VIEW3D_PT_limit_textures

__all__ = ["append_menus", "attach_presets", "classes", "detach_presets", "remove_menus"]

classes = (
    VIEW3D_PT_limit_surface,
    VIEW3D_PT_limit_textures,
    VIEW3D_MT_object_limit_surface,
    VIEW3D_PT_limit_hair_presets,
    VIEW3D_PT_limit_points_presets,
    VIEW3D_PT_limit_hair,
    VIEW3D_PT_limit_points,
    VIEW3D_PT_limit_draw,
)
