# SPDX-License-Identifier: Apache-2.0
"""A head and a sculpt of it, in Blender: for the table and the pictures of docs/displacement.md."""

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.reading import attributes

LEVELS = 3  # subdivisions of the sculpt
QUALITY = 8  # of the modifier, for the polygons that are rendered


def add_base() -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    ob = bpy.context.active_object
    ob.name = ob.data.name = "Head"
    _add_subsurf(ob)
    return ob


def add_sculpt(base: bpy.types.Object) -> bpy.types.Object:
    """A copy with wrinkles that overhang, which no displacement along normals can make."""
    ob = base.copy()
    ob.data, ob.name = base.data.copy(), "Sculpt"
    bpy.context.collection.objects.link(ob)
    subsurf = ob.modifiers[0]
    subsurf.use_limit_surface, subsurf.levels = False, LEVELS
    with bpy.context.temp_override(object=ob, active_object=ob):
        bpy.ops.object.modifier_apply(modifier=subsurf.name)
    normals = np.empty((len(ob.data.vertices), 3), np.float32)
    ob.data.vertices.foreach_get("normal", normals.ravel())
    at = attributes.read(ob.data, ids.POSITION)
    attributes.write(ob.data, ids.POSITION, "FLOAT_VECTOR", "POINT", at + moves(at, normals))
    ob.data.update()
    _add_subsurf(ob)
    bpy.context.view_layer.objects.active = base
    return ob


def moves(at: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """How far the vertices move: ridges around the head that grow outward and hang down."""
    x, y, z = at.T
    ridges = ((1 + np.sin(20 * z + 2 * np.sin(4 * x) + 3 * y)) ** 2)[:, None] / 4
    fade = 1 / (1 + (at[:, :1] / 0.75) ** 6)  # less on the ears
    return fade * ridges * (0.07 * normals + [0, 0, -0.07])


def _add_subsurf(ob: bpy.types.Object) -> None:
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.quality = QUALITY
    subsurf.uv_smooth = "SMOOTH_ALL"  # under the other rules the map folds over beside the eyes
