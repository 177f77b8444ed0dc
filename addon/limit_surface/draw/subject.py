# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn on, and the Curve object whose strokes are continued."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ..errors import RefusalError
from ..placing.followers import surface_of
from ..tasks.object_keys import ObjectKey
from .curve_object import check_drawable


@dataclass(frozen=True)
class Subject:
    surface: bpy.types.Object
    edited: bpy.types.Object | None  # None: a new object is made


@dataclass(frozen=True)
class Keys:
    """Finds the subject again after a while."""

    surface: ObjectKey
    edited: ObjectKey | None

    @classmethod
    def of(cls, found: Subject) -> Keys:
        return cls(ObjectKey.of(found.surface), found.edited and ObjectKey.of(found.edited))

    def find(self) -> Subject:
        """Raises RefusalError if an object has been removed."""
        return Subject(self.surface.find(), self.edited and self.edited.find())


def find(context: bpy.types.Context) -> Subject:
    """Returns the active mesh; or the active Curve object, or hair, with the mesh that it lies on.
    Raises RefusalError where there is nothing to draw on.
    """
    if context.mode != "OBJECT":
        raise RefusalError("Only available in Object Mode")
    active = context.active_object
    surface, edited = None, None
    if active is not None and active.type == "MESH":
        surface = active
    elif active is not None and active.type == "CURVES":
        surface = active.data.surface
    elif active is not None and active.type == "CURVE":
        surface, edited = surface_of(active), active
    if surface is None:
        raise RefusalError(
            "Select the mesh on which you want to draw, or a curve that was drawn on a mesh. It "
            "must be the active object"
        )
    if not surface.visible_get(view_layer=context.view_layer):
        raise RefusalError(f"{surface.name} is hidden: show it to draw on it")
    if edited is not None:
        check_drawable(edited, surface)
    return Subject(surface, edited)
