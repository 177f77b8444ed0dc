# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn on, and the Curve object whose strokes are continued."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ..errors import RefusalError
from ..placing.followers import surface_of
from .curve_object import check_editable


@dataclass(frozen=True)
class Subject:
    surface: bpy.types.Object
    edited: bpy.types.Object | None  # None: a new object is made


def find(context: bpy.types.Context) -> Subject:
    """Returns the active mesh; or the active Curve object, or hair, with the mesh that it lies on.
    Raises RefusalError where there is nothing to draw on.
    """
    if context.mode != "OBJECT":
        raise RefusalError("Only available in Object Mode")
    active = context.active_object
    if active is not None and active.type == "MESH":
        return Subject(active, None)
    if active is not None and active.type == "CURVES" and active.data.surface is not None:
        return Subject(active.data.surface, None)
    surface = surface_of(active) if active is not None and active.type == "CURVE" else None
    if surface is None:
        raise RefusalError("Make the mesh to draw on active, or a curve that was drawn on a mesh")
    check_editable(active, surface)
    return Subject(surface, active)
