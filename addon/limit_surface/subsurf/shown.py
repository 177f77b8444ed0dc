# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the viewport shows the limit surface of an object, by the settings of its modifier."""

from __future__ import annotations

from typing import NamedTuple

import bpy

from ..reading import rules
from .setup import QUALITY


class Shown(NamedTuple):
    text: str  # what is shown, in a few words
    is_limit: bool  # whether the displayed vertices lie on the limit surface
    is_far: bool = True  # whether one can see that they do not


def of(ob: bpy.types.Object, scene: bpy.types.Scene) -> Shown:
    """Returns what the viewport shows of a mesh. Nothing is evaluated, so panels may ask at each
    drawing.
    """
    if rules.find_subsurf(ob) is None:
        return Shown("Control mesh: no modifier", False)
    subsurf = rules.shown_subsurf(ob)
    if subsurf is None:
        return Shown("Control mesh: modifier is off", False)
    level = shown_level(subsurf, scene)
    if level == 0:
        return Shown("Control mesh: level is 0", False)
    if subsurf.subdivision_type == "SIMPLE":
        return Shown(f"Level {level}, simple", True, False)
    if not subsurf.use_limit_surface:
        return Shown(f"Level {level}, not on limit surface", False)
    if subsurf.quality < QUALITY:
        return Shown(f"Level {level}, near limit surface", False, False)
    return Shown(f"Level {level}, on limit surface", True, False)


def shown_level(subsurf: bpy.types.SubsurfModifier, scene: bpy.types.Scene) -> int:
    """Returns the level at which the viewport shows the modifier, which Simplify may lower."""
    render = scene.render
    return (
        min(subsurf.levels, render.simplify_subdivision) if render.use_simplify else subsurf.levels
    )
