# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene remembers of the tab Limit: `scene.limit_surface`."""

import bpy
from bpy.props import PointerProperty


def _is_mesh(_settings: bpy.types.PropertyGroup, ob: bpy.types.Object) -> bool:
    return ob.type == "MESH"


class LimitSurfaceSettings(bpy.types.PropertyGroup):
    target: PointerProperty(
        name="Snap Target",
        description="Mesh on whose limit surface things are snapped outside Object Mode; in "
        "Object Mode the active mesh is the target",
        type=bpy.types.Object,
        poll=_is_mesh,
    )


def attach_settings() -> None:
    bpy.types.Scene.limit_surface = PointerProperty(type=LimitSurfaceSettings)


def detach_settings() -> None:
    del bpy.types.Scene.limit_surface
