# SPDX-License-Identifier: GPL-3.0-or-later
"""What users are told, and offered, where things are placed on a limit surface that no modifier
shows.
"""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import BoolProperty

from ..tasks.request_size import RequestSize
from .region import Region

MOST_VERTICES = 10_000  # so many vertices are measured at most
WIDTH = 340  # of the dialog, in pixels
LINE = 55  # characters on a line of the dialog


class AddSubsurfProperty:
    """Mixin with the property by which the surface gets a Subdivision Surface modifier."""

    add_subsurf: BoolProperty(
        name="Add Subdivision Surface",
        description="Add a Subdivision Surface modifier that shows the limit surface, if the mesh "
        "has none",
        default=False,
        options={"SKIP_SAVE"},
    )


def open_dialog(context: bpy.types.Context, operator: bpy.types.Operator) -> set[str]:
    return context.window_manager.invoke_props_dialog(
        operator, width=WIDTH, title=operator.bl_label, confirm_text="Make"
    )


def question(surface: str, size: RequestSize) -> str:
    """Returns what the dialog asks. It names the size only if that is very large, because presets
    in the dialog change it.
    """
    text = (
        f"{surface} has no Subdivision Surface modifier, so its limit surface is not shown. What "
        "stands on that surface will seem to float, or to be inside the mesh."
    )
    return f"{text} Make {size}?" if size.is_large else text


def gap(covered: Region) -> float:
    """Returns the largest distance, in the world, of the covered faces' vertices from the limit
    surface. Of very many vertices some are measured.
    """
    sizes = covered.cage.face_sizes
    has_surface = np.ones(len(sizes), bool)
    has_surface[list(covered.surface.refused)] = False
    corners = covered.cage.mesh.face_vertices[np.repeat(has_surface, sizes)]
    vertices = np.unique(corners)
    some = vertices[:: -(-len(vertices) // MOST_VERTICES)]
    with covered.in_world():
        distance = covered.surface.closest(covered.cage.world_positions()[some]).distance
    return float(distance.max())


def warning(surface: str, distance: float, noun: str) -> str:
    return (
        f"{surface} has no Subdivision Surface modifier: its mesh is up to {distance:.3g} away "
        f"from the limit surface, on which the {noun} stand"
    )


def short_warning(distance: float) -> str:
    return f"No Subdivision Surface modifier: the mesh is up to {distance:.3g} away"
