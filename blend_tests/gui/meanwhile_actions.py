# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions for the window tests of what somebody does while something runs."""

import bpy
from actions import region, remember, view

ADDON = "bl_ext.user_default.limit_surface"


def animate_sheet() -> None:
    """The sheet rises by a shape key until frame 20, and is moved from there until frame 40, where
    it is not bent any more. Subdivision is its only modifier.
    """
    ob = bpy.data.objects["Sheet"]
    ob.modifiers.new("Subdivision", "SUBSURF")
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Bent")
    for point in key.data:
        point.co.z += 0.5
    start = ob.location.copy()
    for frame, value, x in ((1, 0, 0), (20, 1, 0), (40, 0, 0.6)):
        key.value, ob.location = value, start
        ob.location.x += x
        key.keyframe_insert("value", frame=frame)
        ob.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(1)


def go_to_frame(frame: int) -> None:
    bpy.context.scene.frame_set(frame)


def move_pin_after_a_step() -> None:
    remember()
    bpy.data.objects["Pin"].location.x += 1


def in_another_window(change: str) -> None:
    """Does something in a second window, which is closed again."""
    bpy.ops.wm.window_new()
    other = bpy.context.window_manager.windows[-1]
    with bpy.context.temp_override(window=other):
        if change == "remove":
            bpy.data.objects.remove(bpy.data.objects["Pin"])
        elif change == "undo":
            bpy.ops.ed.undo()
        else:
            bpy.ops.object.mode_set(mode="OBJECT")
    other = bpy.context.window_manager.windows[-1]
    with bpy.context.temp_override(window=other):
        bpy.ops.wm.window_close()


def disable_and_enable() -> None:
    """Does what the checkbox in the Preferences does, twice."""
    bpy.ops.preferences.addon_disable(module=ADDON)
    bpy.ops.preferences.addon_enable(module=ADDON)


def middle_of(kind: str) -> tuple[float, float]:
    """Returns the middle of a region of the viewport; near the left edge where that is long."""
    area, _window = view()
    found = region(area, kind)
    return found.x + min(found.width, 400) / 2, found.y + found.height / 2


def points(name: str) -> list[tuple[float, ...]]:
    """Returns the positions of a mesh's vertices, in Edit Mode as before it."""
    return [tuple(vertex.co) for vertex in bpy.data.objects[name].data.vertices]
