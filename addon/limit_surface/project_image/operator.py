# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_project_image."""

import bpy

from .. import ids
from ..errors import RefusalError
from ..images import texel_places
from ..images.texture_operator import TextureOperator
from ..reading import cage
from ..tasks.job import Job
from ..tasks.refused_faces import left_out
from . import decal_job, properties, texture_job
from .world import WorldSurface

MODES = {"TEXTURE": texture_job, "DECAL": decal_job}


class OBJECT_OT_limit_project_image(
    TextureOperator, properties.ProjectionProperties, bpy.types.Operator
):
    """Project an image onto the active mesh's limit surface: into a texture, or as a mesh that
    lies on it"""

    bl_idname = ids.PROJECT_IMAGE
    bl_label = "Project Image on Limit Surface"
    too_large = "There is not enough memory for so many texels or polygons"
    cancelled = "Cancelled: nothing was projected"

    def draw_properties(self) -> None:
        properties.draw(self.layout, self.properties)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        ob = context.active_object
        if self.mode == "DECAL" and self.source not in properties.ALONG_RAYS:
            raise RefusalError("A decal can be made only from a camera, a view or a planar empty")
        depsgraph = context.evaluated_depsgraph_get()
        if self.mode == "DECAL":
            found = cage.read(ob, depsgraph)
            self.rely_on(ob)
        else:
            found = texel_places.read_cage(ob, depsgraph, self.uv_map)
            self.rely_on(ob, named=[found.chosen_uv_map.name])
        world = WorldSurface(found, ob.name)
        order = MODES[self.mode].order(self.properties, context, world, ob)
        return self.watch(context, Job(order.work), f"Projecting {self.image}")

    def finish(
        self, context: bpy.types.Context, made: texture_job.Made | decal_job.Made
    ) -> set[str]:
        ob = made.order.surface.find()
        self.summary, warnings = made.put(context, ob)
        world = made.order.world
        for warning in filter(None, warnings):
            self.report({"WARNING"}, warning)
        refused = len(world.surface.refused)
        if refused:
            self.report({"WARNING"}, left_out(refused, len(world.cage.face_sizes)))
        self.report({"INFO"}, "; ".join([self.summary, *world.cage.notes]))
        return {"FINISHED"}
