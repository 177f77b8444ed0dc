# SPDX-License-Identifier: GPL-3.0-or-later
"""The subdivision that the viewport and renders show, on whose polygons particles stand."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..errors import RefusalError
from ..tasks.object_keys import ObjectKey


@contextmanager
def at_render_levels(context: bpy.types.Context, surface: ObjectKey) -> Iterator[None]:
    """Has Blender evaluate the surface with the subdivision that renders have. Raises RefusalError
    where drivers do not allow it.
    """
    render = context.scene.render
    subsurfs = _subsurfs(surface.find())
    was = {m.name: (m.levels, m.show_viewport) for m in subsurfs}
    most = render.simplify_subdivision
    try:
        render.simplify_subdivision = render.simplify_subdivision_render
        for modifier in subsurfs:
            modifier.levels, modifier.show_viewport = modifier.render_levels, modifier.show_render
        depsgraph = context.evaluated_depsgraph_get()
        for modifier in _subsurfs(surface.find().evaluated_get(depsgraph)):
            now = modifier.levels, modifier.show_viewport
            if now != (modifier.render_levels, modifier.show_render):
                raise RefusalError(
                    f"Drivers set the viewport levels of {modifier.name}: choose the levels of the "
                    "viewport, or remove the drivers"
                )
        yield
    finally:
        context.scene.render.simplify_subdivision = most
        for name, (levels, is_shown) in was.items():
            modifier = surface.find().modifiers.get(name)
            if modifier is not None:
                modifier.levels, modifier.show_viewport = levels, is_shown


def warning(context: bpy.types.Context, surface: bpy.types.Object, levels: str) -> str:
    """Returns a warning where the viewport and renders do not show the same polygons, or nothing.
    `levels` are those at which the keys were written.
    """
    scene = context.scene
    render = scene.render
    evaluated = surface.evaluated_get(context.evaluated_depsgraph_get())
    for modifier in _subsurfs(evaluated):  # with the values that drivers and animation give
        viewport = modifier.levels if modifier.show_viewport else 0
        of_renders = modifier.render_levels if modifier.show_render else 0
        if render.use_simplify:
            viewport = min(viewport, render.simplify_subdivision)
            of_renders = min(of_renders, render.simplify_subdivision_render)
        if viewport == of_renders:
            continue
        exact, other = ("the viewport", viewport), ("renders", of_renders)
        if levels == "RENDER":
            exact, other = other, exact
        return (
            f"The particles match the strands in {exact[0]} (level {exact[1]}), but not in "
            f"{other[0]} (level {other[1]}): give {modifier.name} the same levels for both"
        )
    return ""


def _subsurfs(ob: bpy.types.Object) -> list[bpy.types.SubsurfModifier]:
    return [modifier for modifier in ob.modifiers if modifier.type == "SUBSURF"]
