# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a surface hands on its control mesh: where *Limit Capture* is among its modifiers."""

from __future__ import annotations

import bpy

from .. import ids
from ..nodes import groups
from ..reading import rules


def obstacle(surface: bpy.types.Object) -> str:
    """Returns a sentence about why the surface does not hand on its control mesh, or nothing."""
    capture = next(groups.modifiers(surface, ids.CAPTURE_GROUP), None)
    if capture is None:
        reason = "was deleted"
    elif not (capture.show_viewport and capture.show_render):
        reason = "is disabled"
    else:
        reason = _misplaced(surface, capture)
    return f"{surface.name}: the modifier {ids.CAPTURE_GROUP} {reason}" if reason else ""


def hands_on_another_mesh(surface: bpy.types.Object) -> bool:
    """Tells whether *Limit Capture* hands on another mesh than the control mesh."""
    capture = next(groups.modifiers(surface, ids.CAPTURE_GROUP), None)
    return capture is not None and bool(_misplaced(surface, capture))


def _misplaced(surface: bpy.types.Object, capture: bpy.types.NodesModifier) -> str:
    subsurf = rules.find_subsurf(surface)
    here = surface.modifiers.find(capture.name)
    if subsurf is None:
        later = [m for m in surface.modifiers[here + 1 :] if m.show_viewport or m.show_render]
        return "has to be the last one, because none of them subdivides the mesh" if later else ""
    there = surface.modifiers.find(subsurf.name)
    if here > there or any(m.show_viewport for m in surface.modifiers[here + 1 : there]):
        return "is not directly before the Subdivision Surface modifier"
    return ""
