# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in Edit Mode, whose vertices Blender gives one by one. The arrays of a copy are read many
times faster.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import bmesh
import bpy


@contextmanager
def as_edited(mesh: bpy.types.Mesh) -> Iterator[bpy.types.Mesh]:
    """Yields a copy of a mesh in its Edit Mode state, whose arrays can be read."""
    copy = bpy.data.meshes.new("Edited")
    try:
        bmesh.from_edit_mesh(mesh).to_mesh(copy)
        yield copy
    finally:
        bpy.data.meshes.remove(copy)
