# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage of the report's results: numbers on the object, distances on its mesh."""

import bpy
import numpy as np

from .. import ids
from ..reading import attributes
from . import colours

_KINDS = {ids.DISTANCE: "FLOAT", ids.DISTANCE_COLOR: "FLOAT_COLOR"}


def store_numbers(ob: bpy.types.Object, results: dict[str, dict[str, float]]) -> None:
    """Stores a custom property with the level and the distances in world units of each displayed
    mesh.
    """
    ob[ids.REPORT] = results


def check_attributes(ob: bpy.types.Object) -> None:
    """Raises RefusalError where these names belong to something else."""
    attributes.check_names(ob, _KINDS, "POINT")


def store_on_mesh(mesh: bpy.types.Mesh, distance: np.ndarray, full: float) -> None:
    attributes.write(mesh, ids.DISTANCE, "FLOAT", "POINT", distance)
    color = colours.of_distances(distance, full)
    attributes.write(mesh, ids.DISTANCE_COLOR, "FLOAT_COLOR", "POINT", color)
    mesh.color_attributes.active_color = mesh.color_attributes[ids.DISTANCE_COLOR]
    mesh.update()
