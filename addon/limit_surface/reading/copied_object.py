# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of objects whose modifiers give what those of the originals give."""

import bpy


def of(ob: bpy.types.Object) -> bpy.types.Object:
    """Returns a copy that is in no collection. Blender leaves out where nodes have baked to, so
    that the copy would compute anew what its original reads from files.
    """
    copy = ob.copy()
    for collection in copy.users_collection:  # the copy of a rigid body is one, too
        collection.objects.unlink(copy)
    for modifier, original in zip(copy.modifiers, ob.modifiers, strict=True):
        folder = getattr(original, "bake_directory", "")
        if folder:
            modifier.bake_directory = folder
    return copy


def show_as_rendered(copy: bpy.types.Object) -> None:
    """Has the viewport run the modifiers that renders run."""
    for modifier in copy.modifiers:
        modifier.show_viewport = modifier.show_render
