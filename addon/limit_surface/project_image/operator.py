# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_project_image."""

import bpy

from .. import ids
from ..errors import RefusalError
from ..images import texel_places
from ..placing import new_objects
from ..reading import cage
from ..tasks import polling
from ..tasks.job import Job
from ..tasks.watched_operator import WatchedOperator
from . import decal_job, properties, texture_job
from .world import WorldSurface

MODES = {"TEXTURE": texture_job, "DECAL": decal_job}


class OBJECT_OT_limit_project_image(
    WatchedOperator, properties.ProjectionProperties, bpy.types.Operator
):
    """Project an image onto the active mesh's limit surface: into a texture, or as a mesh that
    lies on it"""

    bl_idname = ids.PROJECT_IMAGE
    bl_label = "Project Image on Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    too_large = "Not enough memory for so many texels or polygons"
    cancelled = "Cancelled: nothing was projected"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.mesh_in_object_mode(cls, context, context.active_object)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self._someone_waits = True
        return context.window_manager.invoke_props_dialog(self, width=380)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        properties.draw(layout, self.properties)
        if self.summary:
            layout.label(text=self.summary, icon="INFO")

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        ob = context.active_object
        if self.mode == "DECAL" and self.source not in properties.THROWN:
            raise RefusalError("Decals are made from a camera, a view or an empty's plane only")
        depsgraph = context.evaluated_depsgraph_get()
        if self.mode == "DECAL":
            found = cage.read(ob, depsgraph)
        else:
            found = texel_places.read_cage(ob, depsgraph, self.uv_map)
        world = WorldSurface(found, ob.name)
        order = MODES[self.mode].order(self.properties, context, world, new_objects.key(ob))
        return self.watch(context, Job(order.work), f"Projecting {self.image}")

    def finish(
        self, context: bpy.types.Context, made: texture_job.Made | decal_job.Made
    ) -> set[str]:
        ob = new_objects.find(made.order.surface)
        self.summary = made.put(context, ob)
        world = made.order.world
        if made.warning:
            self.report({"WARNING"}, made.warning)
        refused = len(world.surface.refused)
        if refused:
            self.report(
                {"WARNING"},
                f"{refused:,} of {len(world.cage.face_sizes):,} faces have no limit surface and "
                "were left out",
            )
        self.report({"INFO"}, "; ".join([self.summary, *world.cage.notes]))
        return {"FINISHED"}
