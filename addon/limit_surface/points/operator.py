# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_points_add."""

from collections.abc import Callable

import bpy
import numpy as np
from bpy.props import StringProperty

from .. import attributes, ids, roots
from ..binding import Binding
from ..errors import RefusalError
from ..objects import add_on_surface
from ..scatter import ScatterOperator, Target
from .instances import put_instances


class OBJECT_OT_limit_points_add(ScatterOperator, bpy.types.Operator):
    """Scatter points over the active mesh's limit surface: vertices that carry the surface's
    normal, tangent and rotation, and an instance of an object on each if you like"""

    bl_idname = ids.POINTS_ADD
    bl_label = "Add Points on Limit Surface"
    noun = "points"

    instance: StringProperty(
        name="Instance",
        description="Name of an object to put on each point, its Z along the surface's normal and "
        "its X along growing u",
    )

    def check_properties(self) -> None:
        if self.instance and self.instance not in bpy.data.objects:
            raise RefusalError(f"There is no object {self.instance!r} to put on the points")

    def draw_own(self, layout: bpy.types.UILayout) -> None:
        layout.prop_search(self, "instance", bpy.data, "objects")

    def build(
        self, context: bpy.types.Context, target: Target, progress: Callable[[float], None]
    ) -> None:
        count = len(target.locations)
        binding = Binding(target.locations)
        normal, tangent = (np.empty((count, 3), np.float32) for _ in range(2))
        for part in roots.evaluate(target.surface, target.locations, progress):
            binding.fill(part)
            tangent[part.rows] = part.frame[:, :, 0]
            normal[part.rows] = part.frame[:, :, 2]

        mesh = bpy.data.meshes.new(ids.POINTS_OBJECT)
        try:
            mesh.vertices.add(count)
            attributes.write(mesh, "position", "FLOAT_VECTOR", "POINT", binding.root)
            binding.write(mesh, "POINT")
            attributes.write(mesh, ids.NORMAL, "FLOAT_VECTOR", "POINT", normal)
            attributes.write(mesh, ids.TANGENT, "FLOAT_VECTOR", "POINT", tangent)
            attributes.write(mesh, ids.ROTATION, "QUATERNION", "POINT", binding.rotation)
            mesh.update()
            ob = add_on_surface(context, ids.POINTS_OBJECT, mesh, target.ob)
            if self.instance:
                put_instances(ob, bpy.data.objects[self.instance])
        except BaseException:
            bpy.data.meshes.remove(mesh)
            raise
