# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that refer to a data-block.

Blender looks through the file itself, which is far quicker than a script that looks at every
object: panels ask at each drawing.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy


def objects_using(*blocks: bpy.types.ID) -> list[bpy.types.Object]:
    """Returns all objects that refer to one of the data-blocks, in the order of bpy.data.objects:
    by name, and those of libraries last.
    """
    return sorted(set(_users(blocks, {"OBJECT"})), key=_order)


def own_objects_using(*blocks: bpy.types.ID) -> list[bpy.types.Object]:
    """Returns the file's own objects that refer to one of the data-blocks, directly or by their
    hair curves, whose surface it is.
    """
    users = _users(blocks, {"OBJECT", "CURVES"})
    curves = [user for user in users if user.id_type == "CURVES"]
    found = {user for user in users if user.id_type == "OBJECT"}.union(_users(curves, {"OBJECT"}))
    return sorted((ob for ob in found if ob.library is None), key=_order)


def _users(blocks: Sequence[bpy.types.ID], types: set[str]) -> list[bpy.types.ID]:
    if not blocks:
        return []
    found = bpy.data.user_map(subset=blocks, value_types=types)
    return [user for block in blocks for user in found[block]]


def _order(ob: bpy.types.Object) -> tuple[bool, str, str]:
    return ob.library is not None, ob.name.casefold(), ob.name
