# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether things that follow live still stand on the faces to which they were bound.

Modifiers before the subdivision may add and remove faces in each frame, as long as those on which
things stand keep their numbers: only the artist knows whether they do. If the surface's own mesh
has been edited since, or if it has other modifiers that replace faces, its faces have to be those
of the binding.
"""

from __future__ import annotations

import bpy

from .. import ids
from ..errors import RefusalError
from ..nodes import groups
from ..reading import modifier_kinds, rules
from ..tasks.unchanged import faces_of
from . import following


class StaleFacesError(RefusalError):
    """Things were bound to other faces. They stay where they are."""

    remedy = ids.REBIND


def source_of(surface: bpy.types.Object, faces: tuple[int, int, int] | None = None) -> str:
    """Returns what the surface's faces come from: the faces of its own mesh, which differ where
    these numbers do, and the modifiers that may replace faces.
    """
    replacing = [
        modifier.type
        for modifier in _before_subdivision(surface)
        if modifier.type not in modifier_kinds.DEFORMING | modifier_kinds.APPENDING
        and not _is_own(modifier)
    ]
    return " ".join(map(str, (*(faces or faces_of(surface.data)), *replacing)))


def store(data: bpy.types.ID, surface: bpy.types.Object, signature: str) -> None:
    """Stores with the data that it is bound to the surface as it is now."""
    data[ids.SIGNATURE], data[ids.LIVE_SOURCE] = signature, source_of(surface)


def check(ob: bpy.types.Object, surface: bpy.types.Object, source: str, signature: str) -> None:
    """Raises StaleFacesError for an object that is bound to other faces. `source` and `signature`
    are those of the surface as it is now.
    """
    bound = ob.data.get(ids.LIVE_SOURCE)
    if bound == source or following.holds(ob.data, signature):
        return
    if bound is None and _may_change_faces(surface):
        return  # an earlier version of the extension has bound it, and has not stored the source
    raise StaleFacesError(f"The faces of {surface.name} have changed since {ob.name} was bound")


def _may_change_faces(surface: bpy.types.Object) -> bool:
    return any(
        modifier.type not in modifier_kinds.DEFORMING and not _is_own(modifier)
        for modifier in _before_subdivision(surface)
    )


def _before_subdivision(surface: bpy.types.Object) -> list[bpy.types.Modifier]:
    return list(surface.modifiers[: rules.place_of_subsurf(surface)])


def _is_own(modifier: bpy.types.Modifier) -> bool:
    return modifier.type == "NODES" and bool(groups.name_of(modifier.node_group))
