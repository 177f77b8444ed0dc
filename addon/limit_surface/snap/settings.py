# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene remembers of the tab Limit: `scene.limit_surface`."""

import bpy
from bpy.props import PointerProperty

# Blender 4.2 as a module crashes at the interpreter's exit if a pointer has a function that polls.
_can_poll = bool(bpy.app.binary_path) or bpy.app.version >= (4, 5)


def _is_mesh(_settings: bpy.types.PropertyGroup, ob: bpy.types.Object) -> bool:
    return ob.type == "MESH"


class LimitSurfaceSettings(bpy.types.PropertyGroup):
    target: PointerProperty(
        name="Snap Target",
        description="Mesh on whose limit surface things are snapped outside Object Mode; in "
        "Object Mode the active mesh is the target",
        type=bpy.types.Object,
        poll=_is_mesh if _can_poll else None,
    )


def attach_settings() -> None:
    bpy.types.Scene.limit_surface = PointerProperty(type=LimitSurfaceSettings)


def detach_settings() -> None:
    del bpy.types.Scene.limit_surface
