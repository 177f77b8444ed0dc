# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_curve_lay."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from .. import ids, native
from ..errors import RefusalError
from ..tasks import polling
from ..tasks.properties import SummaryProperty, draw_summary
from . import curve_object, properties, result, splines
from .fitting import Fit, Spline
from .ground import Ground

NOTHING = "Select curves, and make the mesh to lay them on active"


class OBJECT_OT_limit_curve_lay(properties.FitProperties, SummaryProperty, bpy.types.Operator):
    """Lay the selected curves onto the exact limit surface of the active mesh, between their
    control points too: their splines are fitted again, so that no place of them is farther from the
    surface than the tolerance"""

    bl_idname = ids.CURVE_LAY
    bl_label = "Lay Curves on Limit Surface"
    bl_options = {"REGISTER", "UNDO"}

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

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        try:
            return self._run(context)
        except native.refusals as error:
            self.report({"ERROR"}, str(error))
        except MemoryError:
            self.report({"ERROR"}, "There is not enough memory for so many control points")
        return {"CANCELLED"}

    def _run(self, context: bpy.types.Context) -> set[str]:
        surface, curves = context.active_object, _curves(context)
        for ob in curves:
            curve_object.check_editable(ob, surface)
        if len({ob.data for ob in curves}) < len(curves):
            raise RefusalError("Two of the selected objects share their curves: make them single")
        ground = Ground(surface, context.evaluated_depsgraph_get())
        for ob in curves:
            curve_object.check_places(ob, ground)
        tolerance = ground.tolerance(self.tolerance)
        fit = Fit(self.spline, tolerance, self.offset)
        laid = [_laid(ob, ground, fit, tolerance) for ob in curves]
        for ob, (made, numbers) in zip(curves, laid, strict=True):
            curve_object.change(context, ob, ground, numbers, made)
            curve_object.store_offset(ob.data, self.offset)
        everything = [spline for made, _numbers in laid for spline in made]
        self.summary = result.summary(everything, 0, ground, self.offset)
        result.warn_of_pieces(self, len(everything), sum(len(numbers) for _made, numbers in laid))
        result.warn_of_deviation(self, tolerance, everything)
        self.report({"INFO"}, "; ".join([self.summary, *ground.posed.cage.notes]))
        return {"FINISHED"}


def _laid(
    ob: bpy.types.Object, ground: Ground, fit: Fit, tolerance: float
) -> tuple[list[Spline], list[int]]:
    """Returns the new splines, and the numbers of those that they replace."""
    matrix = np.array(ob.matrix_world, np.float64)
    by_spline = splines.strokes(ob, ground, tolerance)
    if not by_spline:
        raise RefusalError(f"{ob.name} has no spline with two control points or more")
    made = []
    for stroke in by_spline:
        before = ob.data.splines[stroke.spline]
        look = {name: getattr(before, name) for name in ("material_index", "use_smooth")}
        made.append(replace(fit.spline(stroke, ground, matrix), **look))
    return made, sorted({stroke.spline for stroke in by_spline})


def _curves(context: bpy.types.Context) -> list[bpy.types.Object]:
    return [
        ob for ob in context.selected_objects if ob.type == "CURVE" and ob != context.active_object
    ]
