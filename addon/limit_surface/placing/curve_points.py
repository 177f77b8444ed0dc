# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve objects that follow a surface: each control point follows the place on the surface that
was closest to it. The places are on the vertices of a hidden table.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..nodes import groups
from ..nodes.follow_curve import FOLLOW_CURVE, POINTS
from ..reading import cage, splines
from ..tasks.refused_faces import check_some_left
from . import following, tables
from .binding import Binding
from .followers import curve_table
from .posed_surface import PosedSurface, at_closest, transformed
from .rotations import WorldSpace


class CurveRequest:
    """The binding of Curve objects to one surface, also of such that follow it already: their
    control points get new places.

    Raises RefusalError where that cannot be; nothing has changed then.
    """

    def __init__(
        self,
        curves: Sequence[bpy.types.Object],
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        use_proxy: bool | None = None,
    ) -> None:
        self._curves, self._surface, self._use_proxy = list(curves), surface, use_proxy
        for ob in curves:
            check(ob, surface)
        if not curves:
            return
        # what else follows the surface may refuse, before the curves have changed
        following.Request(surface, depsgraph, without=curves)
        posed = PosedSurface(cage.read(surface, depsgraph))
        check_some_left(posed.in_world, surface.name)
        self._points = [splines.positions(ob.data) for ob in curves]
        self._places = [
            _places(ob, points, posed) for ob, points in zip(curves, self._points, strict=True)
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
    curves: Sequence[bpy.types.Object], surface: bpy.types.Object, context: bpy.types.Context
) -> list[following.Outcome]:
    """Makes Curve objects follow at once. Raises what CurveRequest raises."""
    return CurveRequest(curves, surface, context.evaluated_depsgraph_get()).write(context)


def _store(ob: bpy.types.Object, points: np.ndarray, places: Binding) -> None:
    """Writes the places of a curve into its table, which is made if it has none of its own."""
    table = curve_table(ob)
    if table is None or len(tables.readers(table)) > 1:  # a copy of the curve reads it
        table = tables.new_object(ids.CURVE_TABLE, ob)
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
    data = ob.data
    if data.dimensions == "2D":
        raise RefusalError(f"{ob.name} is a 2D curve, which stays in its plane: make it 3D")
    if data.bevel_depth or data.extrude or (data.bevel_mode == "OBJECT" and data.bevel_object):
        raise RefusalError(
            f"{ob.name} has a bevel or is extruded, so that nodes do not see its control points: "
            "set Bevel Depth and Extrude to 0, and give it its thickness by the node Curve to Mesh "
            "in a Geometry Nodes modifier"
        )
    if not any(len(splines.points(spline)) for spline in data.splines):
        raise RefusalError(f"{ob.name} has no control points")


def has_others(ob: bpy.types.Object) -> bool:
    """Tells whether the number of control points is not that of before."""
    table = curve_table(ob)
    return table is None or len(table.data.vertices) != len(splines.positions(ob.data))


def _places(ob: bpy.types.Object, points: np.ndarray, posed: PosedSurface) -> Binding:
    matrix = np.array(ob.matrix_world, np.float64)
    WorldSpace(matrix)  # refuses a scale of 0
    hits = posed.in_world.closest(transformed(matrix, points.astype(np.float64)))
    return Binding.at(posed, at_closest(posed, hits), matrix)
