# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_report."""

from dataclasses import dataclass

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

from .. import ids
from ..errors import RefusalError
from ..reading import cage, displayed_mesh
from ..tasks.job import Progress
from ..tasks.object_keys import ObjectKey
from ..tasks.piecewise_job import Pieces, PiecewiseJob, aside
from ..tasks.properties import draw_summary
from ..tasks.refused_faces import left_out
from ..tasks.watched_operator import WatchedOperator
from .distances import Distances, measure_all
from .storage import check_attributes, store_numbers, store_on_mesh
from .text import numbers, sentence, short_sentence


@dataclass(frozen=True)
class Measured:
    surface: ObjectKey
    cage: cage.Cage
    results: dict[str, Distances]
    refused: int


class OBJECT_OT_limit_report(WatchedOperator, bpy.types.Operator):
    """Measure how far the polygons that Blender shows are from the limit surface: the smooth
    surface that infinitely many subdivisions approach. Store this distance as an attribute and as
    colors"""

    bl_idname = ids.REPORT_OPERATOR
    bl_label = "Report Distance to Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    too_large = "There is not enough memory for so many polygons"
    cancelled = "Cancelled: nothing was measured"

    levels: EnumProperty(
        name="Levels",
        description="Which displayed mesh is measured",
        items=(
            (
                "BOTH",
                "Viewport and Render",
                "Measure both meshes. The colors and the attribute show the viewport's distances",
                "",
                0,
            ),
            ("VIEWPORT", "Viewport", "Measure the mesh at the viewport's subdivision level", "", 1),
            ("RENDER", "Render", "Measure the mesh at the render's subdivision level", "", 2),
            ("LEVEL", "Other", "Measure the mesh at another subdivision level", "", 3),
        ),
        default="BOTH",
    )
    level: IntProperty(
        name="Level",
        description="Number of subdivisions of the mesh, with the quality that the modifier has",
        default=3,
        min=1,
        max=6,
    )
    full_color: FloatProperty(
        name="Full Color",
        description="Distance at which the color becomes yellow, in world units. 0 chooses the "
        "largest distance that is found",
        default=0.0,
        min=0.0,
        soft_max=1.0,
        precision=5,
        subtype="DISTANCE",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "levels")
        if self.levels == "LEVEL":
            layout.prop(self, "level")
        layout.prop(self, "full_color")
        draw_summary(layout, self.summary)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        name = context.active_object.name
        return self.watch(context, PiecewiseJob(self._pieces(context)), f"Measuring {name}")

    def finish(self, context: bpy.types.Context, made: Measured) -> set[str]:
        ob = made.surface.find()
        not_stored = cage.why_not_on_mesh(ob, made.cage)
        if not_stored:
            self.report({"WARNING"}, f"The attributes were not stored: {not_stored}")
        else:
            check_attributes(ob)
            at_vertices = next(iter(made.results.values())).at_vertices
            store_on_mesh(ob.data, at_vertices, self.full_color or float(at_vertices.max()))
        kept = {name: numbers(result) for name, result in made.results.items()}
        if ob.is_editable:
            store_numbers(ob, kept)
        self._report(ob, made.cage, kept, made.refused)
        return {"FINISHED"}

    def _pieces(self, context: bpy.types.Context) -> Pieces:
        """Reads one displayed mesh in each piece: Blender may take seconds to make it. Then all are
        measured aside.
        """
        key, frame = ObjectKey.of(context.active_object), context.scene.frame_float
        meshes: dict[str, displayed_mesh.DisplayedMesh] = {}
        ob, depsgraph = key.find(), context.evaluated_depsgraph_get()
        found = cage.read(ob, depsgraph)
        self.rely_on(ob)
        if not cage.why_not_on_mesh(ob, found):
            check_attributes(ob)
        for name, kind in self._kinds().items():
            ob, depsgraph = key.find(), context.evaluated_depsgraph_get()
            if context.scene.frame_float != frame:
                raise RefusalError("The frame has changed meanwhile: stop the playback first")
            meshes[name] = displayed_mesh.read(ob, depsgraph, found, kind)
            yield 0.0

        def work(progress: Progress) -> Measured:
            return Measured(key, found, *measure_all(found, meshes, progress))

        return (yield from aside(work))

    def _kinds(self) -> dict[str, displayed_mesh.Kind]:
        if self.levels == "LEVEL":
            return {"LEVEL": self.level}
        kinds: dict[str, displayed_mesh.Kind] = {"VIEWPORT": "VIEWPORT", "RENDER": "RENDER"}
        return kinds if self.levels == "BOTH" else {self.levels: kinds[self.levels]}

    def _report(
        self,
        ob: bpy.types.Object,
        found: cage.Cage,
        kept: dict[str, dict[str, float]],
        refused: int,
    ) -> None:
        lines = [sentence(*item) for item in kept.items()]
        self.summary = "\n".join(lines)
        if refused:
            self.report({"WARNING"}, left_out(refused, len(found.face_sizes)))
        if "RENDER" in kept and (warning := displayed_mesh.warning_of_renders(ob)):
            self.summary += f"\n{warning}"
            self.report({"WARNING"}, warning)
        short = "; ".join(short_sentence(*item) for item in kept.items())
        self.report({"INFO"}, "; ".join([f"{ob.name}: {short}", *found.notes]))
