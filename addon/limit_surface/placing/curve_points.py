# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve objects that follow a surface: each control point follows a place on the surface, the one
that was closest to it unless its location is known. The places are on the vertices of a hidden
table.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import bpy
import numpy as np
from mathutils import Matrix

from .. import ids
from ..errors import RefusalError
from ..nodes import groups
from ..nodes.follow_curve import FOLLOW_CURVE, POINTS
from ..reading import attributes, cage, splines, transform
from ..tasks.refused_faces import check_some_left
from . import following, tables
from .binding import Binding
from .followers import curve_table, surface_of
from .posed_surface import PosedSurface, at_closest, transformed
from .roots import Locations

#: The largest difference between a bound root and its place that counts as none, as a share of the
#: largest coordinate: some times what single precision rounds off.
MOVED = 1e-5


class CurveRequest:
    """The binding of Curve objects to one surface, also of such that follow it already: their
    control points get new places. `known` holds the locations of the control points of curves for
    which they are known; other points are bound to the closest places.

    Raises RefusalError where that cannot be; nothing has changed then.
    """

    def __init__(
        self,
        curves: Sequence[bpy.types.Object],
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        use_proxy: bool | None = None,
        known: Mapping[bpy.types.Object, Locations] | None = None,
    ) -> None:
        self._curves, self._surface, self._use_proxy = list(curves), surface, use_proxy
        for ob in curves:
            check(ob, surface)
        if not curves:
            return
        check_others(surface, depsgraph, curves)
        posed = PosedSurface(cage.read(surface, depsgraph))
        check_some_left(posed.in_world, surface.name)
        self._points = [splines.positions(ob.data) for ob in curves]
        known = known or {}
        self._places = [
            _places(ob, points, posed, known.get(ob))
            for ob, points in zip(curves, self._points, strict=True)
        ]

    def write(self, context: bpy.types.Context) -> list[following.Outcome]:
        if not self._curves:
            return []
        for ob, points, places in zip(self._curves, self._points, self._places, strict=True):
            _store(ob, points, places)
        depsgraph = context.evaluated_depsgraph_get()
        request = following.Request(self._surface, depsgraph, self._curves, self._use_proxy)
        return [request.compute().write()]


def bind(
    curves: Sequence[bpy.types.Object],
    surface: bpy.types.Object,
    context: bpy.types.Context,
    known: Mapping[bpy.types.Object, Locations] | None = None,
) -> list[following.Outcome]:
    """Makes Curve objects follow at once. Raises what CurveRequest raises."""
    depsgraph = context.evaluated_depsgraph_get()
    return CurveRequest(curves, surface, depsgraph, known=known).write(context)


def check_others(
    surface: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    without: Sequence[bpy.types.Object] = (),
) -> None:
    """Raises RefusalError if the surface, or something else that follows it, does not allow that a
    curve is bound. It is asked before anything has changed.
    """
    following.Request(surface, depsgraph, without=without)


def check_any(ob: bpy.types.Object) -> None:
    """Raises RefusalError for a curve that has nothing to bind. One that follows already may lose
    all of its points, and gets new ones later.
    """
    if not len(splines.positions(ob.data)):
        raise RefusalError(f"{ob.name} has no control points")


def check_pose(ob: bpy.types.Object, surface: bpy.types.Object, posed: PosedSurface) -> None:
    """Raises RefusalError if a curve follows the surface, and the surface has another shape or
    place now than when the curve was bound, or the curve's object was moved since. The curve's own
    points are then not where it is shown.
    """
    table = curve_table(ob)
    if table is None:
        return
    face = attributes.read(table.data, ids.FACE)
    if len(face) and int(face.max()) >= posed.in_object.face_count:
        raise RefusalError(
            f"{ob.name} is bound to faces that no longer exist: run Rebind to Limit Surface"
        )
    found = Locations(face, attributes.read(table.data, ids.UV))
    bound = attributes.read(table.data, ids.REST_ROOT)
    if _are_same(bound, Binding.at(posed, found, transform.world_matrix(ob)).root):
        return
    # What is drawn on a surface shares its transform. If the places at rest are those of now in
    # the surface's own space, the surface is as it was.
    if len(bound) and _are_same(bound, Binding.at(posed, found, posed.cage.matrix).root):
        raise RefusalError(
            f"The object {ob.name} was moved, turned or scaled since its curve was bound to "
            f"{surface.name}. The curve is still shown on {surface.name}, but its control points "
            f"are elsewhere. To change the curve, {_way_back(ob, surface)}"
        )
    raise RefusalError(
        f"{ob.name} follows {surface.name}, which has another shape now than when the curve was "
        "bound, or one of the two was moved. To change the curve, go back to that frame, pose or "
        "place. Or use Unbind from Limit Surface with the shape At Rest: the curve then stops "
        "following, and goes back to the shape that it had when it was bound"
    )


def _are_same(bound: np.ndarray, now: np.ndarray) -> bool:
    size = np.abs(bound).max(initial=0.0)
    return bool(np.abs(now - bound).max(initial=0.0) <= MOVED * size)


def _way_back(ob: bpy.types.Object, surface: bpy.types.Object) -> str:
    """Returns how an object gets the transform of its surface again."""
    is_child = ob.parent == surface and ob.parent_type == "OBJECT"
    if is_child and ob.matrix_parent_inverse == Matrix() and not ob.constraints:
        return "clear the object's location, rotation and scale (Object > Clear)"
    return f"give the object the same location, rotation and scale as {surface.name} again"


def _store(ob: bpy.types.Object, points: np.ndarray, places: Binding) -> None:
    """Writes the places of a curve into its table, which is made if it has none of its own."""
    table = curve_table(ob)
    if table is None or len(tables.readers(table)) > 1:  # a copy of the curve reads it
        table = tables.hidden_object(ids.CURVE_TABLE, ob)
    tables.fill(table.data, points)
    places.write(table.data, "POINT")
    table.data.pop(ids.SIGNATURE, None)  # that of the places before
    modifier = next(groups.modifiers(ob, ids.FOLLOW_CURVE_GROUP), None)
    if modifier is None:
        modifier = groups.add_modifier(ob, FOLLOW_CURVE, place=0)
    groups.set_input(modifier, POINTS, table)


def check(ob: bpy.types.Object, surface: bpy.types.Object) -> None:
    """Raises RefusalError for a curve that cannot follow the surface."""
    following.check_thing(ob, surface)
    theirs = surface_of(ob)
    if theirs not in (None, surface):  # once it is bound, it counts as standing on that mesh
        raise RefusalError(
            f"{ob.name} belongs to {theirs.name}, its parent, and not to {surface.name}: clear the "
            "parent to bind the curve to another mesh"
        )
    data = ob.data
    if data.dimensions == "2D":
        raise RefusalError(f"{ob.name} is a 2D curve, which stays in its plane: make it 3D")
    if data.bevel_depth or data.extrude or (data.bevel_mode == "OBJECT" and data.bevel_object):
        raise RefusalError(
            f"{ob.name} has a bevel or is extruded, so that nodes do not see its control points: "
            "set Bevel Depth and Extrude to 0, and give it its thickness by the node Curve to Mesh "
            "in a Geometry Nodes modifier"
        )


def has_others(ob: bpy.types.Object) -> bool:
    """Tells whether the number of control points is not that of before, or there are none."""
    table, count = curve_table(ob), len(splines.positions(ob.data))
    return table is None or not count or len(table.data.vertices) != count


def _places(
    ob: bpy.types.Object, points: np.ndarray, posed: PosedSurface, known: Locations | None
) -> Binding:
    matrix = transform.world_matrix(ob)
    if known is not None:
        return Binding.at(posed, known, matrix)
    at = transformed(matrix, points.astype(np.float64))
    lost = np.flatnonzero(~np.isfinite(at).all(axis=1))
    if len(lost):
        raise RefusalError(
            f"Control point {lost[0]} of {ob.name} has a coordinate that is not a finite number"
        )
    hits = posed.in_world.closest(at)
    return Binding.at(posed, at_closest(posed, hits), matrix)
