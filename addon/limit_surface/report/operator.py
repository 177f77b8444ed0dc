# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_report."""

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import cage, displayed, ids, native, polling
from ..errors import RefusalError
from ..progress import progress_bar
from .distances import measure
from .storing import check_attributes, store_numbers, store_on_mesh, why_not_on_mesh
from .text import numbers, sentence


class OBJECT_OT_limit_report(bpy.types.Operator):
    """Measure how far the mesh that Blender shows is from the limit surface, and store it as an
    attribute and as colors"""

    bl_idname = ids.REPORT_OPERATOR
    bl_label = "Report Distance to Limit Surface"
    bl_options = {"REGISTER", "UNDO"}

    levels: EnumProperty(
        name="Levels",
        description="Which of the meshes that Blender can show is measured",
        items=(
            ("BOTH", "Viewport and Render", "Both; colors and attribute are the viewport's", "", 0),
            ("VIEWPORT", "Viewport", "The mesh at the levels that the viewport shows", "", 1),
            ("RENDER", "Render", "The mesh at the levels that a render shows", "", 2),
            ("LEVEL", "Other", "The mesh as it would be at another level", "", 3),
        ),
        default="BOTH",
    )
    level: IntProperty(
        name="Level",
        description="Subdivisions of the mesh, with the modifier's own quality",
        default=3,
        min=1,
        max=6,
    )
    full_color: FloatProperty(
        name="Full Color",
        description="Distance from which on the color is yellow, in world units. At 0 it is the "
        "largest distance that is found",
        default=0.0,
        min=0.0,
        soft_max=1.0,
        precision=5,
        subtype="DISTANCE",
    )
    summary: StringProperty(
        name="Result",
        description="What the operator found, a line for each mesh",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.active_mesh(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            return self._run(context)
        except (RefusalError, *native.errors) as error:
            reason = str(error)
        except MemoryError:
            reason = "Not enough memory for so many polygons"
        self.report({"ERROR"}, reason)
        return {"CANCELLED"}

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "levels")
        if self.levels == "LEVEL":
            layout.prop(self, "level")
        layout.prop(self, "full_color")
        for line in self.summary.splitlines():
            layout.label(text=line, icon="INFO")

    def _run(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        ob, depsgraph = context.active_object, context.evaluated_depsgraph_get()
        found = cage.read(ob, depsgraph)
        not_stored = why_not_on_mesh(ob, found)
        if not not_stored:
            check_attributes(ob.data)
        meshes = {
            name: displayed.read(ob, depsgraph, found, kind) for name, kind in self._kinds().items()
        }
        surface = native.limitsurf.LimitSurface(found.mesh)
        surface.set_positions(found.world_positions())
        if len(surface.refused) == len(found.face_sizes):
            raise RefusalError(f"No face of {ob.name} has a limit surface")
        results = {}
        with progress_bar(context.window_manager) as progress:
            for i, (name, shown) in enumerate(meshes.items()):
                results[name] = measure(
                    surface, found, shown, lambda part, i=i: progress((i + part) / len(meshes))
                )
        if not_stored:
            self.report({"WARNING"}, f"Attributes are not stored: {not_stored}")
        else:
            at_vertices = next(iter(results.values())).at_vertices
            store_on_mesh(ob.data, at_vertices, self.full_color or float(at_vertices.max()))
        kept = {name: numbers(result) for name, result in results.items()}
        if ob.is_editable:
            store_numbers(ob, kept)
        self._report(ob, found, kept, len(surface.refused))
        return {"FINISHED"}

    def _kinds(self) -> dict[str, displayed.Kind]:
        if self.levels == "LEVEL":
            return {"LEVEL": self.level}
        names = ("VIEWPORT", "RENDER") if self.levels == "BOTH" else (self.levels,)
        return {name: name for name in names}

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
            self.report(
                {"WARNING"},
                f"{refused:,} of {len(found.face_sizes):,} faces have no limit surface and were "
                "left out",
            )
        notes = [f"{ob.name}: {'; '.join(lines)}", str(found.rules)]
        if found.ignored:
            notes.append(f"ignored behind {found.rules.subsurf}: {', '.join(found.ignored)}")
        self.report({"INFO"}, "; ".join(notes))
