# SPDX-License-Identifier: GPL-3.0-or-later
"""What has to be there before an operator can run."""

import bpy

from . import native


def active_mesh(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """A mesh object, in Object Mode; the operator's poll message says what is missing."""
    ob = context.active_object
    if not native.available():
        operator.poll_message_set(f"The native module does not load: {native.reason}")
    elif ob is None or ob.type != "MESH":
        operator.poll_message_set("Make a mesh object active first")
    elif context.mode != "OBJECT":
        operator.poll_message_set("Only in Object Mode")
    else:
        return True
    return False
