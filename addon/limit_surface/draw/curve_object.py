# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve objects on the surface: new ones, and splines added to those that exist."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..nodes import groups, tube
from ..placing import curve_points
from ..placing.follow_properties import follows
from ..placing.followers import sharers
from ..placing.new_objects import add_on_surface
from ..placing.posed_surface import at_closest, transformed
from ..placing.roots import Locations
from ..placing.rotations import WorldSpace
from ..reading import splines as blender_splines
from ..reading import transform
from ..tasks.editable import check_data_editable
from . import splines
from .fitting import Spline
from .ground import Ground


@dataclass(frozen=True)
class Thickness:
    radius: float  # world units; 0: none
    bevel_resolution: int


def add_new(
    context: bpy.types.Context,
    ground: Ground,
    made: Sequence[Spline],
    thickness: Thickness,
    follow: str,
) -> bpy.types.Object:
    is_bound = check_follows(follow, ground, context.evaluated_depsgraph_get())
    data = bpy.data.curves.new(ids.DRAWING_OBJECT, "CURVE")
    try:
        data.dimensions = "3D"
        splines.add(data, made)
        splines.store_locations(data, splines.joined([spline.locations for spline in made]))
        scale = WorldSpace(ground.matrix).mean_scale
        if thickness.radius and not is_bound:
            data.bevel_depth = thickness.radius / scale
            data.bevel_resolution = thickness.bevel_resolution
            data.use_fill_caps = True
        ob = add_on_surface(context, ids.DRAWING_OBJECT, data, ground.ob)
    except BaseException:
        bpy.data.curves.remove(data)
        raise
    if is_bound:
        found = splines.joined([spline.locations for spline in made])
        curve_points.bind([ob], ground.ob, context, {ob: found})
        if thickness.radius:
            # Nodes see control points only where the curve itself has no bevel.
            sides = 4 * (thickness.bevel_resolution + 1)
            tube.add_tube(ob, thickness.radius / scale, sides)
    context.view_layer.update()
    return ob


def change(
    context: bpy.types.Context,
    ob: bpy.types.Object,
    ground: Ground,
    removed: Sequence[int],
    made: Sequence[Spline],
) -> None:
    """Replaces splines of a Curve object by others, once its places have been checked."""
    data = ob.data
    kept = _kept_locations(ob, ground, removed)
    splines.remove(data, removed)
    splines.add(data, made)
    found = splines.joined([kept, *(spline.locations for spline in made)])
    splines.store_locations(data, found)
    if _is_bound(ob):
        curve_points.bind([ob], ground.ob, context, {ob: found})


def _is_bound(ob: bpy.types.Object) -> bool:
    return next(groups.modifiers(ob, ids.FOLLOW_CURVE_GROUP), None) is not None


def store_offset(data: bpy.types.Curve, offset: float) -> None:
    """Keeps the offset, with which the curve is continued later."""
    if offset:
        data[ids.OFFSET] = offset
    else:
        data.pop(ids.OFFSET, None)


def _kept_locations(ob: bpy.types.Object, ground: Ground, removed: Sequence[int]) -> Locations:
    """Returns the locations of the control points that remain: those that are stored, or else the
    closest ones.
    """
    counts = [len(blender_splines.points(spline)) for spline in ob.data.splines]
    stays = np.ones(len(counts), bool)
    stays[list(removed)] = False
    rows = np.repeat(stays, counts)
    found = splines.locations(ob.data)
    if found is None:
        matrix = np.array(ob.matrix_world, np.float64)
        points = transformed(matrix, blender_splines.positions(ob.data).astype(np.float64))
        found = at_closest(ground.posed, ground.surface.closest(points))
    return Locations(found.face[rows], found.uv[rows])


def check_follows(follow: str, ground: Ground, depsgraph: bpy.types.Depsgraph) -> bool:
    """Tells whether a new object is to follow the surface. Raises RefusalError if it cannot."""
    is_bound = follows(follow, ground.ob)
    if is_bound:
        curve_points.check_others(ground.ob, depsgraph)
    return is_bound


def check_places(ob: bpy.types.Object, ground: Ground, depsgraph: bpy.types.Depsgraph) -> None:
    """Raises RefusalError for a Curve object whose points cannot be compared with the surface, or
    that follows it and could not be bound again.
    """
    transform.world_matrix(ob)  # refuses a scale of 0
    for number, spline in enumerate(ob.data.splines):
        points = blender_splines.points(spline)
        names = ("co", "handle_left", "handle_right") if spline.type == "BEZIER" else ("co",)
        if not all(np.isfinite(blender_splines.values(points, name)).all() for name in names):
            raise RefusalError(
                f"Spline {number} of {ob.name} has coordinates that are not finite numbers"
            )
    curve_points.check_pose(ob, ground.ob, ground.posed)
    if _is_bound(ob):
        curve_points.check_others(ground.ob, depsgraph, [ob])


def check_drawable(ob: bpy.types.Object, surface: bpy.types.Object) -> None:
    """Raises RefusalError for a Curve object on which nobody can draw."""
    data = ob.data
    if not ob.is_editable:
        raise RefusalError(f"{ob.name} is linked from another file")
    check_data_editable(data)
    others = sharers(ob)
    if others:
        raise RefusalError(
            f"{ob.name} shares its curves with {others[0].name}, which would change as well: make "
            "it a single-user copy first"
        )
    if data.shape_keys:
        raise RefusalError(
            f"{ob.name} has shape keys, so no points can be added or removed: delete the shape "
            "keys first"
        )
    if data.dimensions == "2D":
        raise RefusalError(f"{ob.name} is a 2D curve, which stays in its plane: make it 3D")
    if _is_bound(ob):
        curve_points.check(ob, surface)
