# SPDX-License-Identifier: GPL-3.0-or-later
"""Which part of a library override belongs to the library.

Python may remove and move modifiers that Blender's own buttons leave alone: those that come from
the library. Blender does not save that. It brings them back when the file is opened, and makes
copies of others, so that the stack is another one then.
"""

import bpy


def is_of_library(modifier: bpy.types.Modifier) -> bool:
    """Tells whether a modifier can be neither removed nor moved, because its object is a library
    override and has it from the library.
    """
    # is_override_data means nothing for objects that are no overrides
    return modifier.id_data.override_library is not None and modifier.is_override_data


def make_own(ob: bpy.types.Object) -> bpy.types.Object:
    """Makes an object that was copied from a library override one of the file's own, so that its
    modifiers can be removed. Its data stays that of the library.
    """
    return ob.make_local(clear_liboverride=True) if ob.override_library else ob
