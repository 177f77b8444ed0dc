# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_rebind."""

import math

import bpy
from bpy.props import EnumProperty, FloatProperty

from .. import ids
from ..errors import RefusalError
from ..placing.binding_operator import BindingOperator, rely_on_bound
from ..placing.rebinding import Rebinding
from ..tasks import polling
from ..tasks.piecewise_job import Pieces
from ..tasks.properties import draw_summary
from . import children_rebinding
from .subjects import children_to_rebind, has_to_rebind, to_rebind

_NOTHING = "Select a surface that something follows, or what follows it"


class OBJECT_OT_limit_rebind(BindingOperator, bpy.types.Operator):
    """Bind again everything that follows the selected surface. Do this after faces, creases or
    settings of the Subdivision Surface modifier have changed. Live children are made again with
    the same settings"""

    bl_idname = ids.REBIND
    bl_label = "Rebind to Limit Surface"
    bl_options = {"REGISTER", "UNDO"}

    method: EnumProperty(
        name="Method",
        description="How the new places on the changed surface are found",
        items=(
            (
                "CLOSEST",
                "Closest Point",
                "Use the point of the surface that is closest to the root or point at rest. Go to "
                "a frame in which the surface has the shape that it had when things were bound: in "
                "another pose they move to the places that are closest there",
                0,
            ),
            (
                "UV",
                "UV",
                "Use the point with the UV that is stored with the root, after a "
                "change of topology that keeps the UV map",
                1,
            ),
            (
                "FACE",
                "Face",
                "Keep the face and the place on it, after a change of creases, settings or "
                "positions, but not of faces",
                2,
            ),
        ),
    )
    distance: FloatProperty(
        name="Distance",
        description="Largest distance from the surface, in world units. Strands and points that "
        "are farther away are not bound. 0 means any distance",
        min=0.0,
        default=0.0,
        subtype="DISTANCE",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.in_object_mode(cls, context, lambda: has_to_rebind(context), _NOTHING)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "method")
        if self.method == "CLOSEST":
            layout.prop(self, "distance")
        draw_summary(layout, self.summary)

    def bind(self, context: bpy.types.Context) -> Pieces:
        by_surface = to_rebind(context)
        children = children_to_rebind(context, by_surface)
        if not by_surface and not children:
            raise RefusalError(_NOTHING)
        depsgraph = context.evaluated_depsgraph_get()
        limit = self.distance or math.inf
        rebindings = [
            Rebinding(on, depsgraph, things, self.method, limit)
            for on, things in by_surface.items()
        ]
        self.rely_on(*children)
        for surface, rebinding in zip(by_surface, rebindings, strict=True):
            self.rely_on(surface, named=rebinding.uv_maps)
            rely_on_bound(self, rebinding.bound)
        for rebinding in rebindings:
            yield from rebinding.compute(context)
        done = [rebinding.write(context) for rebinding in rebindings]
        for rebound in done:
            for warning in rebound.warnings:
                self.report({"WARNING"}, warning)
        lines = [str(rebound) for rebound in done]
        for ob in children:
            try:
                lines.append(children_rebinding.make_again(context, ob))
            except RefusalError as error:
                if not lines:
                    raise
                self.report({"WARNING"}, str(error))
        self.summary = "\n".join(lines)
        self.report({"INFO"}, self.summary.replace("\n", ". "))
        return {"FINISHED"}
