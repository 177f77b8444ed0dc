# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of meshes that Blender has subdivided, with a sculpted shape."""

from collections.abc import Callable

import bpy
import numpy as np
import scenes
from limit_surface import ids
from limit_surface.reading import attributes


def subdivided_copy(ob: bpy.types.Object, levels: int, name: str = "Sculpt") -> bpy.types.Object:
    """Makes a mesh of its own, with the vertices where plain subdivision puts them, so that its
    limit surface is the same, and with a modifier of its own.
    """
    copy = ob.copy()
    copy.data, copy.name = ob.data.copy(), name
    bpy.context.collection.objects.link(copy)
    subsurf = next(m for m in copy.modifiers if m.type == "SUBSURF")
    boundary = subsurf.boundary_smooth
    subsurf.use_limit_surface, subsurf.levels = False, levels
    with bpy.context.temp_override(object=copy, active_object=copy):
        bpy.ops.object.modifier_apply(modifier=subsurf.name)
    scenes.add_subsurf(copy, boundary)
    bpy.context.view_layer.update()
    scenes.activate(ob)
    return copy


def positions(ob: bpy.types.Object) -> np.ndarray:
    return attributes.read(ob.data, ids.POSITION).astype(np.float64)


def reshape(ob: bpy.types.Object, change: Callable[[np.ndarray], np.ndarray]) -> bpy.types.Object:
    attributes.write(ob.data, ids.POSITION, "FLOAT_VECTOR", "POINT", change(positions(ob)))
    ob.data.update()
    bpy.context.view_layer.update()
    return ob


def ripples(at: np.ndarray) -> np.ndarray:
    """Moves vertices in all three directions."""
    return at + 0.1 * np.sin(3 * at[:, [1, 2, 0]])
