# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that operators name in a property."""

import bpy

from ..errors import RefusalError


def find_object(name: str, wanted: str) -> bpy.types.Object:
    """Returns the file's object of that name. Raises RefusalError where there is none, and where no
    name is given: the text asks for `wanted` then.
    """
    if not name:
        raise RefusalError(f"Choose {wanted}")
    ob = bpy.data.objects.get(name)
    if ob is None:
        raise RefusalError(f"There is no object {name!r}: choose {wanted}")
    return ob
