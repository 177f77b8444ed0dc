# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh has still the faces for which something was computed. While work runs aside, other
windows, scripts and add-ons may change it.
"""

from __future__ import annotations

import zlib

import bpy
import numpy as np

from ..errors import RefusalError


class Faces:
    """The faces of a mesh in Object Mode, as they are now."""

    def __init__(self, ob: bpy.types.Object) -> None:
        self._faces = faces_of(ob.data)

    def check(self, ob: bpy.types.Object) -> None:
        """Raises RefusalError where the mesh has others now, or is in Edit Mode."""
        if ob.mode == "EDIT":
            raise RefusalError(f"{ob.name} was put into Edit Mode meanwhile: leave it first")
        if faces_of(ob.data) != self._faces:
            raise RefusalError(
                f"The faces of {ob.name} were changed meanwhile: run the operator again"
            )


def faces_of(mesh: bpy.types.Mesh) -> tuple[int, int, int]:
    """Returns what differs where the faces of a mesh in Object Mode do: the numbers of vertices and
    faces, and a checksum of the faces' corners.
    """
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    return len(mesh.vertices), len(mesh.polygons), zlib.crc32(corners.data)
