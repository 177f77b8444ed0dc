# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera as a projector: it shows what a render at the image's resolution would show."""

import bpy
import numpy as np

from ..errors import RefusalError
from . import present_object
from .projector import Projector, inverse

PROJECTIONS = {"PERSP", "ORTHO"}


def find(context: bpy.types.Context, name: str) -> bpy.types.Object:
    """Returns the camera of that name, or the scene's camera where no name is given."""
    if not name:
        if context.scene.camera is None:
            raise RefusalError(
                "There is no camera: the scene has none. Add one, and make it the scene's camera"
            )
        return context.scene.camera
    ob = bpy.data.objects.get(name)
    if ob is None or ob.type != "CAMERA":
        raise RefusalError(f"There is no camera {name!r}")
    return ob


def projector(
    ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph, size: tuple[int, int]
) -> Projector:
    """Returns the projector with the evaluated lens, sensor, shift and clipping, and the scene's
    pixel aspect.
    """
    if ob.type != "CAMERA":
        raise RefusalError(f"{ob.name} is not a camera")
    with present_object.evaluated(ob, depsgraph) as evaluated:
        return _projector(f"The camera {ob.name}", evaluated, depsgraph, size)


def _projector(
    called: str,
    evaluated: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    size: tuple[int, int],
) -> Projector:
    if evaluated.data.type not in PROJECTIONS:
        kind = evaluated.data.bl_rna.properties["type"].enum_items[evaluated.data.type].name
        raise RefusalError(
            f"{called} is {kind.lower()}: only perspective and orthographic cameras can project"
        )
    render = depsgraph.scene.render
    window = evaluated.calc_matrix_camera(
        depsgraph,
        x=size[0],
        y=size[1],
        scale_x=render.pixel_aspect_x,
        scale_y=render.pixel_aspect_y,
    )
    # Blender ignores the camera's scale when it renders.
    placed = np.array(evaluated.matrix_world.normalized(), np.float64)
    matrix = np.array(window, np.float64) @ inverse(placed, called)
    return Projector(called, matrix, has_eye=evaluated.data.type == "PERSP")
