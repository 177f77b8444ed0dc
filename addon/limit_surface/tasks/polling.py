# SPDX-License-Identifier: GPL-3.0-or-later
"""Conditions under which an operator can run."""

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
