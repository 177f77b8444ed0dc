# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_mesh."""

from dataclasses import dataclass

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import ids
from ..errors import RefusalError
from ..placing import new_objects
from ..reading import cage
from ..tasks.job import Job, Progress
from ..tasks.object_keys import ObjectKey
from ..tasks.refused_faces import left_out, reasons
from ..tasks.watched_operator import WatchedOperator, draw_summary
from . import blender_mesh, levels, tessellation


@dataclass(frozen=True)
class _Result:
    surface: ObjectKey
    made: tessellation.Made
    notes: list[str]


class OBJECT_OT_limit_mesh(WatchedOperator, bpy.types.Operator):
    """Make a mesh whose vertices and normals are exactly those of the active mesh's limit surface,
    for renderers that want polygons"""

    bl_idname = ids.LIMIT_MESH
    bl_label = "Mesh on Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    too_large = "Not enough memory for so many polygons"
    cancelled = "Cancelled: no mesh was made"

    level_source: EnumProperty(
        name="Levels From",
        description="What decides how finely each face is divided",
        items=(
            ("UNIFORM", "Uniform", "All faces alike", "", 0),
            ("ATTRIBUTE", "Attribute", "A number on each face, or a vertex group", "", 1),
            ("FLATNESS", "Flatness", "Each face as finely as its polygons have to be to stay close "
             "to the surface", "", 2),
            ("PIXELS", "Pixels", "Each face as finely as its edges have to be to look short from "
             "the scene's camera", "", 3),
        ),
        default="UNIFORM",
    )  # fmt: skip
    levels: IntProperty(
        name="Levels",
        description="A quad becomes 2 to the power of so many polygons a side; faces other than "
        "quads are divided once at least. With a vertex group: where the weight is 1",
        default=3,
        min=0,
        max=levels.MOST,
        soft_max=6,
    )
    level_attribute: StringProperty(
        name="Attribute",
        description="Name of a numeric attribute of faces that holds their levels, or of a vertex "
        "group: each face has the largest weight of its vertices, times Levels",
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="How far polygons may be from the surface, in world units",
        default=0.001,
        min=1e-7,
        soft_max=0.1,
        precision=5,
        subtype="DISTANCE",
    )
    pixels: FloatProperty(
        name="Pixels",
        description="How long edges may be in the render",
        default=4.0,
        min=0.1,
        soft_max=64.0,
        subtype="PIXEL",
    )
    most_levels: IntProperty(
        name="Most Levels",
        description="No face is divided more often, whatever it would need",
        default=6,
        min=1,
        max=levels.MOST,
    )
    exact_normals: BoolProperty(
        name="Exact Normals",
        description="Store the surface's own normals as custom normals, those of each side at "
        "creases",
        default=True,
    )
    store_locations: BoolProperty(
        name="Store Locations",
        description="Store each vertex's place on the surface, as attributes limit_face and "
        "limit_uv",
        default=False,
    )
    hide_original: BoolProperty(
        name="Hide Original",
        description="Hide the active mesh in the viewport and in renders",
        default=False,
    )
    allow_large: BoolProperty(
        name="Allow Large Counts",
        description="Make millions of polygons without asking",
        default=False,
        options={"SKIP_SAVE"},
    )
    summary: StringProperty(
        name="Result",
        description="What the operator made",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "level_source")
        for name in _SHOWN[self.level_source]:
            layout.prop(self, name)
        for name in ("exact_normals", "store_locations", "hide_original", "allow_large"):
            layout.prop(self, name)
        draw_summary(layout, self.summary)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        ob, depsgraph = context.active_object, context.evaluated_depsgraph_get()
        source = tessellation.read(
            ob, depsgraph, self._chooser(context, ob), not self.exact_normals
        )
        notes = [*source.attributes.notes]
        if ob.data.shape_keys:
            notes.append("shape keys are not carried over")
        key, exact_normals, allow_large = ObjectKey.of(ob), self.exact_normals, self.allow_large

        def work(progress: Progress) -> _Result:
            return _Result(key, source.make(exact_normals, allow_large, progress), notes)

        return self.watch(context, Job(work), f"Making polygons on {ob.name}")

    def finish(self, context: bpy.types.Context, result: _Result) -> set[str]:
        surface, made = result.surface.find(), result.made
        mesh = blender_mesh.build(made, surface, context.evaluated_depsgraph_get())
        try:
            if self.store_locations:
                blender_mesh.store_locations(mesh, made)
            ob = new_objects.add_on_surface(context, ids.LIMIT_MESH_OBJECT, mesh, surface)
            blender_mesh.copy_object_materials(surface, ob)
        except BaseException:
            bpy.data.meshes.remove(mesh)
            raise
        if self.hide_original:
            surface.hide_set(True)
            surface.hide_render = True
        self._report(surface, result)
        return {"FINISHED"}

    def _chooser(self, context: bpy.types.Context, ob: bpy.types.Object) -> tessellation.Chooser:
        choice = None
        if self.level_source == "UNIFORM":
            choice = levels.uniform(self.levels)
        elif self.level_source == "FLATNESS":
            choice = levels.within(self.tolerance, self.most_levels)
        elif self.level_source == "PIXELS":
            view = levels.seen_by_camera(context)
            choice = levels.of_pixels(view, self.pixels, self.most_levels)
        elif not self.level_attribute:
            raise RefusalError("Name an attribute of faces, or a vertex group, that has the levels")
        name, most = self.level_attribute, self.levels

        def choose(
            mesh: bpy.types.Mesh, found: cage.Cage, groups: tessellation.Groups
        ) -> levels.Choice:
            return choice or levels.named(name, most, mesh, found, ob, groups.by_name())

        return choose

    def _report(self, surface: bpy.types.Object, result: _Result) -> None:
        made = result.made
        low, high = made.levels
        self.summary = (
            f"{len(made.tessellation.face_sizes):,} polygons on "
            f"{len(made.cage.face_sizes) - len(made.refused):,} faces, "
            + (f"level {low}" if low == high else f"levels {low} to {high}")
        )
        for warning in made.warnings:
            self.report({"WARNING"}, warning)
        if made.refused:
            refused, faces = made.refused, len(made.cage.face_sizes)
            self.report({"WARNING"}, left_out(len(refused), faces, reasons(refused)))
        notes = [f"{self.summary} of {surface.name}", *made.cage.notes, *result.notes]
        self.report({"INFO"}, "; ".join(notes))


_SHOWN = {
    "UNIFORM": ("levels",),
    "ATTRIBUTE": ("level_attribute", "levels"),
    "FLATNESS": ("tolerance", "most_levels"),
    "PIXELS": ("pixels", "most_levels"),
}
