# SPDX-License-Identifier: GPL-3.0-or-later
"""What has to be there before an operator can run."""

import bpy

from .. import native


def mesh_in_object_mode(
    operator: type[bpy.types.Operator],
    context: bpy.types.Context,
    ob: bpy.types.Object | None,
    types: tuple[str, ...] = ("MESH",),
) -> bool:
    """`ob`, which has to be of one of these types, is what would be worked on; the operator's poll
    message says what is missing."""
    if not native.available():
        operator.poll_message_set(native.obstacle())
    elif ob is None or ob.type not in types:
        operator.poll_message_set("Make a mesh object active first")
    elif context.mode != "OBJECT":
        operator.poll_message_set("Only in Object Mode")
    else:
        return True
    return False
