# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a Subdivision Surface modifier, as the rules and names of limitsurf."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import bpy
import numpy as np

Boundary = Literal["smooth", "corners"]
Scheme = Literal["catmark", "bilinear"]
Interpolation = Literal[
    "none", "corners_only", "corners_plus1", "corners_plus2", "boundaries", "all"
]

BOUNDARIES: dict[str, Boundary] = {"ALL": "smooth", "PRESERVE_CORNERS": "corners"}

SCHEMES: dict[str, Scheme] = {"CATMULL_CLARK": "catmark", "SIMPLE": "bilinear"}

# Blender names these rules by what is preserved, OpenSubdiv by what is interpolated linearly. Both
# mean the same.
UV_INTERPOLATIONS: dict[str, Interpolation] = {
    "NONE": "all",
    "PRESERVE_CORNERS": "corners_only",
    "PRESERVE_CORNERS_AND_JUNCTIONS": "corners_plus1",
    "PRESERVE_CORNERS_JUNCTIONS_AND_CONCAVE": "corners_plus2",
    "PRESERVE_BOUNDARIES": "boundaries",
    "SMOOTH_ALL": "none",
}
LINEAR: Interpolation = UV_INTERPOLATIONS["NONE"]


@dataclass(frozen=True)
class Rules:
    """The rules of subdivision. The defaults are those of a new modifier and are used for objects
    that have none.
    """

    subsurf: str = ""  # the name of the modifier
    scheme: Scheme = "catmark"
    boundary: Boundary = "smooth"
    uv_interpolation: Interpolation = (
        "boundaries"  # the rule on the limit surface, whatever the viewport shows
    )
    use_creases: bool = True

    def __str__(self) -> str:
        if self.scheme == "bilinear":
            return f"simple subdivision ({self.subsurf})"
        creases = "" if self.use_creases else ", creases off"
        whose = self.subsurf or "no Subdivision Surface, default rules"
        return f"boundary {self.boundary}{creases} ({whose})"


def find_subsurf(ob: bpy.types.Object) -> bpy.types.SubsurfModifier | None:
    """Returns the modifier whose rules the limit surface follows: the first one that is enabled in
    the viewport, or where there is none, the first that is enabled in renders.
    """
    return shown_subsurf(ob) or rendered_subsurf(ob)


def place_of_subsurf(ob: bpy.types.Object) -> int:
    """Returns the number of modifiers before that modifier, or of all modifiers without one."""
    subsurf = find_subsurf(ob)
    return ob.modifiers.find(subsurf.name) if subsurf else len(ob.modifiers)


def shown_subsurf(ob: bpy.types.Object) -> bpy.types.SubsurfModifier | None:
    """Returns the first Subdivision Surface modifier that is enabled in the viewport."""
    return next((m for m in ob.modifiers if m.type == "SUBSURF" and m.show_viewport), None)


def rendered_subsurf(ob: bpy.types.Object) -> bpy.types.SubsurfModifier | None:
    """Returns the first Subdivision Surface modifier that is enabled in renders."""
    return next((m for m in ob.modifiers if m.type == "SUBSURF" and m.show_render), None)


def why_ambiguous(ob: bpy.types.Object) -> str:
    """Returns why the viewport and renders have different limit surfaces, or None."""
    shown, rendered = shown_subsurf(ob), rendered_subsurf(ob)
    if not (shown and rendered) or shown == rendered:
        return ""
    return (
        f"{ob.name} is subdivided first by {shown.name} in the viewport, but by {rendered.name} in "
        "renders: enable each of them in both, or in neither"
    )


def shown_uv_interpolation(ob: bpy.types.Object, scene: bpy.types.Scene) -> Interpolation:
    """Returns the UV interpolation of the mesh that the viewport shows: UV maps are smooth only
    where it is subdivided.
    """
    simplify = scene.render.simplify_subdivision if scene.render.use_simplify else np.inf
    shown = (
        m
        for m in ob.modifiers
        if m.type == "SUBSURF" and m.show_viewport and min(m.levels, simplify) > 0
    )
    subsurf = next(shown, None)
    return read(subsurf).uv_interpolation if subsurf else LINEAR


def read(subsurf: bpy.types.SubsurfModifier | None) -> Rules:
    if subsurf is None:
        return Rules()
    scheme = SCHEMES[subsurf.subdivision_type]
    return Rules(
        subsurf=subsurf.name,
        scheme=scheme,
        boundary=BOUNDARIES[subsurf.boundary_smooth],
        # Simple subdivision does not smooth UV maps, whatever the setting.
        uv_interpolation=LINEAR if scheme == "bilinear" else UV_INTERPOLATIONS[subsurf.uv_smooth],
        use_creases=subsurf.use_creases,
    )
