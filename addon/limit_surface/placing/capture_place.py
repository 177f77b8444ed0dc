# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a surface hands on its control mesh: where *Limit Capture* is among its modifiers.

If somebody applies that modifier, or converts the surface to a mesh, what it hands on stays in the
mesh and does not change any more. Therefore its attributes count only where it has just been run.
"""

from __future__ import annotations

import bpy

from .. import ids
from ..nodes import groups
from ..nodes.capture import STORED
from ..reading import rules


def obstacle(surface: bpy.types.Object) -> str:
    """Returns a sentence about why the surface does not hand on its control mesh, or nothing."""
    capture = next(groups.modifiers(surface, ids.CAPTURE_GROUP), None)
    if capture is None:
        reason = "was applied" if holds_applied(surface) else "was deleted"
    elif not (capture.show_viewport and capture.show_render):
        reason = "is disabled"
    elif reason := _misplaced(surface, capture):
        return f"{surface.name}: the modifier {ids.CAPTURE_GROUP} {reason}"
    else:
        return ""
    return (
        f"{surface.name}: the modifier {ids.CAPTURE_GROUP} {reason}. Without it, what follows "
        f"{surface.name} by nodes does not move, and what follows it live is slower"
    )


def was_run(ob: bpy.types.Object, evaluated: bpy.types.Object, mode: str) -> bool:
    """Tells whether *Limit Capture* was run when the object was evaluated, for the viewport or for
    renders. The evaluated object has the modifiers of that moment.
    """
    shown = shown_in(mode)
    return any(
        getattr(capture, shown) and (capture.show_in_editmode or not ob.data.is_editmode)
        for capture in groups.modifiers(evaluated, ids.CAPTURE_GROUP)
    )


def shown_in(mode: str) -> str:
    """Returns the property that enables modifiers in a depsgraph of this mode."""
    return "show_viewport" if mode == "VIEWPORT" else "show_render"


def holds_applied(surface: bpy.types.Object) -> bool:
    """Tells whether the surface's own mesh has the attributes of a *Limit Capture* that was
    applied. Users may have attributes of some of these names, but hardly of all.
    """
    if surface.type != "MESH":
        return False
    stored = surface.data.attributes
    return all(
        name in stored and (stored[name].data_type, stored[name].domain) == (kind, "POINT")
        for name, kind in STORED.items()
    )


def has_removable(surface: bpy.types.Object) -> bool:
    """Tells whether it has these attributes, and Blender saves that they are removed."""
    if not holds_applied(surface) or surface.data.is_editmode:
        return False
    return surface.data.is_editable and not surface.data.override_library


def remove_applied(surface: bpy.types.Object) -> None:
    """Removes these attributes where that is possible."""
    if has_removable(surface):
        stored = surface.data.attributes
        for name in STORED:
            stored.remove(stored[name])


def hands_on_another_mesh(surface: bpy.types.Object) -> bool:
    """Tells whether *Limit Capture* hands on another mesh than the control mesh."""
    capture = next(groups.modifiers(surface, ids.CAPTURE_GROUP), None)
    return capture is not None and bool(_misplaced(surface, capture))


def _misplaced(surface: bpy.types.Object, capture: bpy.types.NodesModifier) -> str:
    subsurf = rules.find_subsurf(surface)
    here = surface.modifiers.find(capture.name)
    if subsurf is None:
        later = [m for m in surface.modifiers[here + 1 :] if m.show_viewport or m.show_render]
        if later:
            return (
                f"must be the last modifier, because no modifier of {surface.name} subdivides the "
                "mesh"
            )
        return ""
    there = surface.modifiers.find(subsurf.name)
    if here > there or any(m.show_viewport for m in surface.modifiers[here + 1 : there]):
        return "is not directly before the Subdivision Surface modifier"
    return ""
