# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_mesh."""

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import ids
from ..counting import counted
from ..errors import RefusalError
from ..placing import following, new_objects
from ..placing.binding import Binding
from ..placing.follow_properties import FollowProperties, why_it_stays
from ..placing.roots import Locations, off_vertices
from ..reading import cage
from ..tasks.job import Job, Progress, part_of
from ..tasks.object_keys import ObjectKey
from ..tasks.properties import LargeCountProperty, draw_summary
from ..tasks.refused_faces import left_out, reasons
from ..tasks.watched_operator import WatchedOperator
from . import blender_mesh, levels, tessellation

_MADE = 0.9  # the part of the progress at which the polygons are made


@dataclass(frozen=True)
class _Result:
    surface: ObjectKey
    made: tessellation.Made
    binding: Binding | None  # None: no locations are stored
    bindings: following.Bindings | None  # None: the mesh does not follow the surface
    notes: list[str]


class OBJECT_OT_limit_mesh(
    WatchedOperator, LargeCountProperty, FollowProperties, bpy.types.Operator
):
    """Make a mesh whose vertices and normals are exactly those of the active mesh's limit surface,
    for renderers that need polygons"""

    bl_idname = ids.LIMIT_MESH
    bl_label = "Mesh on Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    too_large = "There is not enough memory for so many polygons"
    cancelled = "Cancelled: no mesh was made"

    level_source: EnumProperty(
        name="Levels From",
        description="What decides how finely each face is divided",
        items=(
            ("UNIFORM", "Uniform", "Divide all faces equally", "", 0),
            (
                "ATTRIBUTE",
                "Attribute",
                "Read each face's level from a face attribute or a vertex group",
                "",
                1,
            ),
            (
                "FLATNESS",
                "Flatness",
                "Divide each face until its polygons are close to the surface",
                "",
                2,
            ),
            (
                "PIXELS",
                "Pixels",
                "Divide each face until its edges are short in the image of the scene's camera",
                "",
                3,
            ),
        ),
        default="UNIFORM",
    )
    levels: IntProperty(
        name="Levels",
        description="Number of subdivisions. At level L a quad has 2^L polygons along each side; "
        "other faces are divided at least once. With a vertex group this is the level where the "
        "weight is 1",
        default=3,
        min=0,
        max=levels.MOST,
        soft_max=6,
    )
    level_attribute: StringProperty(
        name="Attribute",
        description="Name of a numeric face attribute that holds the levels, or of a vertex "
        "group. With a group, a face's level is the largest weight of its vertices, times Levels",
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="Largest distance of the polygons from the surface, in world units",
        default=0.001,
        min=1e-7,
        soft_max=0.1,
        precision=5,
        subtype="DISTANCE",
    )
    pixels: FloatProperty(
        name="Pixels",
        description="Largest length of edges in the render, in pixels",
        default=4.0,
        min=0.1,
        soft_max=64.0,
        subtype="PIXEL",
    )
    most_levels: IntProperty(
        name="Most Levels",
        description="Highest level that a face may get. If it is too low for some faces, a "
        "warning says how many there are",
        default=6,
        min=1,
        max=levels.MOST,
    )
    exact_normals: BoolProperty(
        name="Exact Normals",
        description="Store the exact normals of the surface as custom normals. At creases each "
        "side keeps its own",
        default=True,
    )
    store_locations: BoolProperty(
        name="Store Locations",
        description="Store where each vertex is on the surface, and the directions of the surface "
        "there (tangent and normal), as attributes limit_face, limit_uv, rest_root, rest_rot and "
        "limit_seal. A mesh that follows always has them",
        default=False,
    )
    hide_original: BoolProperty(
        name="Hide Original",
        description="Hide the active mesh in the viewport and in renders",
        default=False,
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "level_source")
        for name in _SHOWN[self.level_source]:
            layout.prop(self, name)
        for name in ("exact_normals", "store_locations", "hide_original", "follow", "allow_large"):
            layout.prop(self, name)
        draw_summary(layout, self.summary)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        ob, depsgraph = context.active_object, context.evaluated_depsgraph_get()
        source = tessellation.read(
            ob, depsgraph, self._chooser(context, ob), not self.exact_normals
        )
        self.rely_on(ob)
        notes = [*source.attributes.notes]
        if ob.data.shape_keys:
            notes.append("shape keys are not carried over")
        key, exact_normals, allow_large = ObjectKey.of(ob), self.exact_normals, self.allow_large
        stored = self.store_locations
        request = following.request_for(self.follow, ob, depsgraph)

        def work(progress: Progress) -> _Result:
            made = source.make(exact_normals, allow_large, part_of(progress, 0, _MADE))
            at = made.tessellation.locations
            locations = Locations(at.face.astype(np.int32), at.uv.astype(np.float32))
            if not request and not stored:
                return _Result(key, made, None, None, notes)
            if request:
                locations = Locations(locations.face, off_vertices(locations.uv))
            binding = Binding.on(made.cage.surface(), locations, part_of(progress, _MADE, 1))
            bindings = request.compute(locations) if request else None
            return _Result(key, made, binding, bindings, notes)

        return self.watch(context, Job(work), f"Making polygons on {ob.name}")

    def finish(self, context: bpy.types.Context, result: _Result) -> set[str]:
        surface, made = result.surface.find(), result.made
        mesh = blender_mesh.build(made, surface, context.evaluated_depsgraph_get())
        try:
            if result.binding:
                result.binding.write(mesh, "POINT")
            ob = new_objects.add_on_surface(context, ids.LIMIT_MESH_OBJECT, mesh, surface)
            blender_mesh.copy_object_materials(surface, ob)
        except BaseException:
            bpy.data.meshes.remove(mesh)
            raise
        if result.bindings:
            result.bindings.write(ob)
        context.view_layer.update()
        if self.hide_original:
            surface.hide_set(True)
            surface.hide_render = True
            if surface.library:
                self.report(
                    {"WARNING"},
                    f"{surface.name} is linked from another file. Renders do not show it now, but "
                    "they will when this file is opened again, because Blender does not save this "
                    "setting of linked objects",
                )
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
            raise RefusalError("Choose a face attribute or a vertex group that holds the levels")
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
            f"{counted(len(made.tessellation.face_sizes), 'polygons')} on "
            f"{counted(len(made.cage.face_sizes) - len(made.refused), 'faces')}, "
            + (f"level {low}" if low == high else f"levels {low} to {high}")
        )
        for warning in made.warnings:
            self.report({"WARNING"}, warning)
        if made.refused:
            refused, faces = made.refused, len(made.cage.face_sizes)
            self.report({"WARNING"}, left_out(len(refused), faces, reasons(refused)))
        notes = [f"{self.summary} of {surface.name}", *made.cage.notes, *result.notes]
        if result.bindings:
            notes.append("its vertices follow the surface by Geometry Nodes")
        elif why := why_it_stays(self.follow, surface):
            notes.append(f"it does not follow the surface: {why}")
        self.report({"INFO"}, "; ".join(notes))


_SHOWN = {
    "UNIFORM": ("levels",),
    "ATTRIBUTE": ("level_attribute", "levels"),
    "FLATNESS": ("tolerance", "most_levels"),
    "PIXELS": ("pixels", "most_levels"),
}
