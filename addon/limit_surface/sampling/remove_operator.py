# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_sample_remove."""

import bpy

from .. import ids, native
from ..placing import all_tiles
from ..tasks import polling


class OBJECT_OT_limit_sample_remove(bpy.types.Operator):
    """Remove what Tables for Sample Limit Surface has added for the active mesh: the hidden tables
    and the mesh Limit Faces"""

    bl_idname = ids.SAMPLE_REMOVE
    bl_label = "Remove Tables for Sample Limit Surface"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.mesh_in_object_mode(cls, context, context.active_object)

    def execute(self, context: bpy.types.Context) -> set[str]:
        surface = context.active_object
        try:
            readers = all_tiles.remove(surface)
        except native.refusals as error:
            self.report({"ERROR"}, native.sentence(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"The tables for {ids.SAMPLE_GROUP} of {surface.name} were removed")
        if readers:
            names = ", ".join(readers)
            self.report({"WARNING"}, f"The removed tables were used by: {names}")
        return {"FINISHED"}
