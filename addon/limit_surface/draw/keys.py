# SPDX-License-Identifier: GPL-3.0-or-later
"""What the mouse buttons and the keys mean while somebody draws.

Only the documented combinations do anything. Whatever else is pressed reaches neither the drawing
nor Blender: the same key with a modifier is another shortcut, which nobody expects here.
"""

from __future__ import annotations

import bpy

MOVES = {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}
LEAVING = {"ESC", "RIGHTMOUSE"}
_VIEW = {"MIDDLEMOUSE", "NDOF_MOTION", "TRACKPADPAN", "TRACKPADZOOM"}
_WHEEL = {"WHEELUPMOUSE", "WHEELDOWNMOUSE"}
#: By whether Ctrl and Shift are held
_TOOLS = {(False, False): "DRAW", (True, False): "ERASE", (False, True): "SMOOTH"}
#: By the key, and whether Ctrl and Shift are held
_COMMANDS = {
    ("RET", False, False): "CONFIRM",
    ("NUMPAD_ENTER", False, False): "CONFIRM",
    ("SPACE", False, False): "CONFIRM",
    ("ESC", False, False): "LEAVE",
    ("RIGHTMOUSE", False, False): "LEAVE",
    ("Z", True, False): "UNDO",
    ("Z", True, True): "REDO",
    ("X", False, False): "MIRROR",
    ("J", False, False): "JOIN",
    ("LEFT_BRACKET", False, False): "SMALLER",
    ("RIGHT_BRACKET", False, False): "LARGER",
}


def tool(event: bpy.types.Event) -> str | None:
    """Returns the tool that a drag with these modifiers is, or None."""
    return None if event.alt or event.oskey else _TOOLS.get((event.ctrl, event.shift))


def command(event: bpy.types.Event) -> str | None:
    """Returns what this key or button with these modifiers asks for, or None."""
    return (
        None
        if event.alt or event.oskey
        else _COMMANDS.get((event.type, bool(event.ctrl), bool(event.shift)))
    )


def is_view(event: bpy.types.Event, is_over_viewport: bool) -> bool:
    """Tells whether Blender may take the event, because it changes nothing but the view."""
    kind = event.type
    if kind in _WHEEL:
        # With Alt it changes the frame, and with Ctrl the number in a field under the mouse.
        return not event.alt and (is_over_viewport or not event.ctrl)
    if kind.startswith("NUMPAD_") and kind != "NUMPAD_ENTER":
        # With Ctrl or Alt the other keys than digits, and 0, change the selection or the camera.
        return not (event.ctrl or event.alt) or kind[-1] in "123456789"
    return kind in _VIEW
