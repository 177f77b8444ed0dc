# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_curve_lay."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..tasks import polling
from ..tasks.piecewise_job import Pieces, PiecewiseJob
from ..tasks.properties import draw_summary
from ..tasks.watched_operator import WatchedOperator
from . import curve_object, properties, result, splines
from .fitting import Fit, Spline
from .ground import Ground

NOTHING = "Select the curves, and then the mesh as the active object"


class OBJECT_OT_limit_curve_lay(properties.FitProperties, WatchedOperator, bpy.types.Operator):
    """Lay the selected curves onto the exact limit surface of the active mesh along their whole
    length. New splines replace the old ones, and are within the tolerance of the surface"""

    bl_idname = ids.CURVE_LAY
    bl_label = "Lay Curves on Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    too_large = "There is not enough memory for so many control points"
    cancelled = "Cancelled: no curve has changed"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        def has_something() -> bool:
            active = context.active_object
            return active is not None and active.type == "MESH" and bool(_curves(context))

        return polling.in_object_mode(cls, context, has_something, NOTHING)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("spline", "tolerance", "offset"):
            layout.prop(self, name)
        draw_summary(layout, self.summary)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        return self.watch(context, PiecewiseJob(self._pieces(context)), "Laying curves")

    def finish(self, _context: bpy.types.Context, made: set[str]) -> set[str]:
        return made

    def _pieces(self, context: bpy.types.Context) -> Pieces:
        """Changes the curves in the last piece, and returns what the operator returns."""
        surface, curves = context.active_object, _curves(context)
        for ob in curves:
            curve_object.check_drawable(ob, surface)
        self.rely_on(surface, placed=True)
        self.rely_on(*curves, placed=True, shape=True)
        depsgraph = context.evaluated_depsgraph_get()
        ground = Ground(surface, depsgraph)
        for ob in curves:
            curve_object.check_places(ob, ground, depsgraph)
        tolerance = ground.tolerance(self.tolerance)
        fit = Fit(self.spline, tolerance, self.offset)
        laid: list[tuple[list[Spline], list[int]]] = []
        count = max(1, sum(len(ob.data.splines) for ob in curves))
        for ob in curves:
            done = sum(len(numbers) for _made, numbers in laid)
            laid.append((yield from _laid(ob, ground, fit, tolerance, done / count, 1 / count)))
        for ob, (made, numbers) in zip(curves, laid, strict=True):
            curve_object.change(context, ob, ground, numbers, made)
            curve_object.store_offset(ob.data, self.offset)
        everything = [spline for made, _numbers in laid for spline in made]
        self.summary = result.summary(everything, 0, ground, self.offset, "curves")
        given = sum(len(numbers) for _made, numbers in laid)
        result.warn_of_pieces(self, len(everything), given, "curves")
        result.warn_of_deviation(self, tolerance, everything)
        result.warn_of_modifiers(self, curves)
        self.report({"INFO"}, "; ".join([self.summary, *ground.posed.cage.notes]))
        return {"FINISHED"}


def _laid(
    ob: bpy.types.Object, ground: Ground, fit: Fit, tolerance: float, done: float, share: float
) -> Pieces:
    """Returns the new splines, and the numbers of those that they replace. Each spline is a `share`
    of the work, of which a part is `done`.
    """
    matrix = np.array(ob.matrix_world, np.float64)
    made: list[Spline] = []
    numbers: list[int] = []
    for strokes in splines.strokes_by_spline(ob, ground, tolerance):
        for stroke in strokes:
            yield done + share * len(numbers)
            before = ob.data.splines[stroke.spline]
            look = {name: getattr(before, name) for name in ("material_index", "use_smooth")}
            made.append(replace(fit.spline(stroke, ground, matrix), **look))
        numbers += sorted({stroke.spline for stroke in strokes})
    if not made:
        raise RefusalError(f"{ob.name} has no spline with two control points or more")
    return made, numbers


def _curves(context: bpy.types.Context) -> list[bpy.types.Object]:
    return [
        ob for ob in context.selected_objects if ob.type == "CURVE" and ob != context.active_object
    ]
