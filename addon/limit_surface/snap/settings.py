# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the sidebar tab Limit that a scene stores: `scene.limit_surface`."""

import bpy
from bpy.props import PointerProperty

# The bpy module 4.2 crashes at the interpreter's exit if a pointer property has a poll function.
_can_poll = bool(bpy.app.binary_path) or bpy.app.version >= (4, 5)


def _is_mesh(_settings: bpy.types.PropertyGroup, ob: bpy.types.Object) -> bool:
    return ob.type == "MESH"


class LimitSurfaceSettings(bpy.types.PropertyGroup):
    target: PointerProperty(
        name="Snap Target",
        description="Mesh object to whose limit surface things are snapped outside Object Mode. "
        "In Object Mode the active mesh is the target",
        type=bpy.types.Object,
        poll=_is_mesh if _can_poll else None,
    )


def attach_settings() -> None:
    bpy.types.Scene.limit_surface = PointerProperty(type=LimitSurfaceSettings)


def detach_settings() -> None:
    del bpy.types.Scene.limit_surface
