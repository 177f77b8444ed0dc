# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_curvature."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

from .. import ids
from ..errors import RefusalError
from ..tasks import polling
from ..tasks.job import Job, Progress
from ..tasks.properties import LargeCountProperty, draw_summary
from ..tasks.watched_operator import WatchedOperator
from . import colours, text
from .control_mesh import ControlMesh
from .roots import StoredRoots
from .settings import Settings
from .tessellation import Tessellation
from .values import Values

Places = ControlMesh | Tessellation | StoredRoots
_PLACES: dict[str, type[Places]] = {
    "CONTROL_MESH": ControlMesh,
    "TESSELLATION": Tessellation,
    "ROOTS": StoredRoots,
}


class OBJECT_OT_limit_curvature(WatchedOperator, LargeCountProperty, bpy.types.Operator):
    """Store the limit surface's exact curvature, its principal directions and colors that show it
    as attributes: of the mesh, of a new mesh, or of hair and points"""

    bl_idname = ids.CURVATURE
    bl_label = "Curvature of Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    too_large = "There is not enough memory for so many places"
    cancelled = "Cancelled: no curvature was stored"

    on: EnumProperty(
        name="On",
        description="Where the curvature is stored",
        items=(
            (
                "CONTROL_MESH",
                "Control Mesh",
                "Store the curvature at the limit position of each vertex of the active mesh",
                "",
                0,
            ),
            (
                "TESSELLATION",
                "New Mesh",
                "Store the curvature on a new mesh whose vertices lie on the limit surface",
                "",
                1,
            ),
            (
                "ROOTS",
                "Hair and Points",
                "Store the curvature at the roots of the selected hair and points that are bound "
                "to a limit surface, or of all that are bound to the active mesh",
                "",
                2,
            ),
        ),
        default="CONTROL_MESH",
    )
    levels: IntProperty(
        name="Levels",
        description="Number of subdivisions of the new mesh",
        default=3,
        min=1,
        max=12,
        soft_max=6,
    )
    space: EnumProperty(
        name="Space",
        description="Space in which lengths are measured",
        items=(
            ("WORLD", "World", "Measure in world space, in 1 / world unit", "", 0),
            ("LOCAL", "Local", "Measure in the object's local space, without its scale", "", 1),
        ),
        default="WORLD",
    )
    radius: FloatProperty(
        name="Radius",
        description="Distance from irregular vertices, such as poles, at which curvature is "
        "averaged over the faces around the vertex, as a fraction of an edge. At the vertex itself "
        "curvature has no value in general",
        default=1 / 64,
        min=2**-20,
        max=0.5,
        precision=4,
    )
    color: EnumProperty(
        name="Color",
        description="Curvature that the colors show: blue where it is negative, red where it is "
        "positive",
        items=(
            (
                "MEAN",
                "Mean",
                "Mean curvature (k1 + k2) / 2, negative where the surface bulges outward",
                "",
                0,
            ),
            ("GAUSSIAN", "Gaussian", "Gaussian curvature k1 * k2, negative on saddles", "", 1),
            ("K1", "Largest", "Larger principal curvature k1", "", 2),
            ("K2", "Smallest", "Smaller principal curvature k2", "", 3),
        ),
        default="MEAN",
    )
    full_color: FloatProperty(
        name="Full Color",
        description="Curvature, positive or negative, that gets the strongest color. 0 chooses a "
        "value such that 95% of the places are paler",
        default=0.0,
        min=0.0,
        soft_max=100.0,
        precision=4,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.mesh_in_object_mode(
            cls, context, context.active_object, types=("MESH", "CURVES")
        )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "on")
        if self.on == "TESSELLATION":
            layout.prop(self, "levels")
            layout.prop(self, "allow_large")
        for name in ("space", "radius", "color", "full_color"):
            layout.prop(self, name)
        draw_summary(layout, self.summary)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        if self.on != "ROOTS" and context.active_object.type != "MESH":
            raise RefusalError("Make a mesh object active first")
        settings = Settings(self.space == "WORLD", self.radius, self.levels, self.allow_large)
        places = _PLACES[self.on](context, settings)
        for ob, names in places.relied_on():
            self.rely_on(ob, named=names)

        def work(progress: Progress) -> tuple[Places, list[Values]]:
            return places, places.measure(progress)

        text_shown = f"Measuring the curvature of {context.active_object.name}"
        return self.watch(context, Job(work), text_shown)

    def finish(self, context: bpy.types.Context, made: tuple[Places, list[Values]]) -> set[str]:
        places, values = made
        shown = [getattr(part, self.color.lower()) for part in values]
        full = self.full_color or colours.full_of(text.together(values, self.color.lower()))
        stored = places.store(context, values, [colours.of_values(of, full) for of in shown])
        lines = text.lines(values, places.noun, self.radius, full, self.color)
        self.summary = "\n".join(lines)
        for warning in (text.without(values, places.noun), *places.notes):
            if warning:
                self.report({"WARNING"}, warning)
        self.report({"INFO"}, f"{stored}: {'; '.join(lines)}")
        return {"FINISHED"}
