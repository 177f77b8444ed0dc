# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects as they are in a frame, whether or not the scene shows them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from . import cage


@contextmanager
def evaluated(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Iterator[bpy.types.Object]:
    """Yields the object as it is at the depsgraph's frame. Blender does not evaluate what is only
    in another scene, or in a collection that is excluded: its own matrix may be an old one, so a
    copy is evaluated in a private scene.
    """
    found = ob.evaluated_get(depsgraph)
    if found.is_evaluated:
        yield found
        return
    with cage.evaluated_copy(ob, len(ob.modifiers), depsgraph) as copy:
        yield copy
