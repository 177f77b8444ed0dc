# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether renders show other faces of a surface than the viewport, because a modifier before the
subdivision is enabled in one of them only. Nodes are bound to the faces that the viewport shows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..errors import CageError, RefusalError
from ..reading import cage, copied_object, modifier_kinds, rules

if TYPE_CHECKING:
    import limitsurf


def why_different(surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> str:
    """Returns a sentence where renders show other faces than the viewport, or nothing. Creases
    count as well.
    """
    names = [modifier.name for modifier in _only_in_one(surface)]
    if not names or _are_same(surface, depsgraph):
        return ""
    which, is_one = ", ".join(names), len(names) == 1
    are = f"the modifier {which} is" if is_one else f"the modifiers {which} are"
    it = "it" if is_one else "each of them"
    return (
        f"{surface.name} has other faces or creases in renders than in the viewport, because {are} "
        "enabled in only one of them. What follows by nodes is then at rest in renders: enable "
        f"{it} in both, or in neither, or choose the mode Live"
    )


def check(surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
    """Raises RefusalError where renders show other faces or creases than the viewport."""
    if reason := why_different(surface, depsgraph):
        raise RefusalError(reason)


def _only_in_one(surface: bpy.types.Object) -> list[bpy.types.Modifier]:
    """Returns the modifiers before the subdivision that may cause such a difference."""
    before = surface.modifiers[: rules.place_of_subsurf(surface)]
    return [
        modifier
        for modifier in before
        if modifier.show_viewport != modifier.show_render
        and modifier.type not in modifier_kinds.DEFORMING
    ]


def _are_same(surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    def as_rendered(copy: bpy.types.Object, _scene: bpy.types.Scene) -> None:
        copied_object.show_as_rendered(copy)

    shown = cage.read(surface, depsgraph)
    try:
        with cage.opened(surface, depsgraph, as_rendered) as (rendered, _mesh):
            return _have_same_faces(shown.mesh, rendered.mesh)
    except CageError:  # no faces are left, say
        return False


def _have_same_faces(one: limitsurf.ControlMesh, other: limitsurf.ControlMesh) -> bool:
    if len(one.positions) != len(other.positions):
        return False
    parts = (
        (
            *(mesh.face_sizes, mesh.face_vertices),
            *(*mesh.edge_sharpness, *mesh.vertex_sharpness),
        )
        for mesh in (one, other)
    )
    return all(map(np.array_equal, *parts))
