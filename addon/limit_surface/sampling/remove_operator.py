# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_sample_remove."""

import bpy

from .. import ids
from ..errors import RefusalError
from ..placing import all_tiles
from ..tasks import polling

_NOTHING = "Select the mesh whose tables you want to remove. It must be the active object"


class OBJECT_OT_limit_sample_remove(bpy.types.Operator):
    """Remove what Tables for Sample Limit Surface has added for the active mesh: the hidden tables
    and the mesh Limit Faces. Remove also those of meshes that were deleted"""

    bl_idname = ids.SAMPLE_REMOVE
    bl_label = "Remove Tables for Sample Limit Surface"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        def has_something() -> bool:
            active = context.active_object
            is_mesh = active is not None and active.type == "MESH"
            return is_mesh or bool(all_tiles.left_behind())

        return polling.in_object_mode(cls, context, has_something, _NOTHING)

    def execute(self, context: bpy.types.Context) -> set[str]:
        left, readers = all_tiles.remove_left_behind()
        said = [left] if left else []
        surface = context.active_object
        if surface is not None and surface.type == "MESH":
            try:
                readers += all_tiles.remove(surface)
                said.append(f"The tables for {ids.SAMPLE_GROUP} of {surface.name} were removed")
            except RefusalError as error:
                if not left:
                    self.report({"ERROR"}, str(error))
                    return {"CANCELLED"}
        self.report({"INFO"}, ". ".join(said))
        if readers:
            names = ", ".join(dict.fromkeys(readers))
            self.report({"WARNING"}, f"The removed tables were used by: {names}")
        return {"FINISHED"}
