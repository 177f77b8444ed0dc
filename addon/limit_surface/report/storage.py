# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the report's results stay: numbers on the object, distances on its mesh."""

import bpy
import numpy as np

from .. import ids
from ..reading import attributes
from . import colours

_KINDS = {ids.DISTANCE: "FLOAT", ids.DISTANCE_COLOR: "FLOAT_COLOR"}


def store_numbers(ob: bpy.types.Object, results: dict[str, dict[str, float]]) -> None:
    """A custom property: for each displayed mesh its level and its distances in world units."""
    ob[ids.REPORT] = results


def check_attributes(ob: bpy.types.Object) -> None:
    """RefusalError where something else has these names."""
    attributes.check_names(ob, _KINDS, "POINT")


def store_on_mesh(mesh: bpy.types.Mesh, distance: np.ndarray, full: float) -> None:
    attributes.write(mesh, ids.DISTANCE, "FLOAT", "POINT", distance)
    color = colours.of_distances(distance, full)
    attributes.write(mesh, ids.DISTANCE_COLOR, "FLOAT_COLOR", "POINT", color)
    mesh.color_attributes.active_color = mesh.color_attributes[ids.DISTANCE_COLOR]
    mesh.update()
