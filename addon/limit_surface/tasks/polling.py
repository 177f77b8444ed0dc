# SPDX-License-Identifier: GPL-3.0-or-later
"""Conditions under which an operator can run."""

from collections.abc import Callable

import bpy

from .. import native


def mesh_in_object_mode(
    operator: type[bpy.types.Operator],
    context: bpy.types.Context,
    ob: bpy.types.Object | None,
    types: tuple[str, ...] = ("MESH",),
) -> bool:
    """Tells whether `ob`, the object to work on, has one of these types and Blender is in Object
    Mode. If not, it sets the operator's poll message.
    """
    if not native.available():
        operator.poll_message_set(native.obstacle())
    elif ob is None or ob.type not in types:
        operator.poll_message_set("Make a mesh object active first")
    elif context.mode != "OBJECT":
        operator.poll_message_set("Only available in Object Mode")
    else:
        return True
    return False


def in_object_mode(
    operator: type[bpy.types.Operator],
    context: bpy.types.Context,
    has_something: Callable[[], bool],
    nothing: str,
) -> bool:
    """Tells whether Blender is in Object Mode and the operator has something to work on. If not, it
    sets the operator's poll message: `nothing` is the one for the latter.
    """
    if not native.available():
        operator.poll_message_set(native.obstacle())
    elif context.mode != "OBJECT":
        operator.poll_message_set("Only available in Object Mode")
    elif not has_something():
        operator.poll_message_set(nothing)
    else:
        return True
    return False
