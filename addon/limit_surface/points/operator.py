# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_points_add."""

from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import StringProperty

from .. import ids
from ..errors import RefusalError
from ..nodes.instances import put_instances
from ..placing import roots
from ..placing.binding import Binding
from ..placing.new_objects import add_on_surface
from ..placing.scatter_operator import Ground, ScatterOperator
from ..reading import attributes, cage
from ..tasks.job import Progress


@dataclass(frozen=True)
class Points:
    binding: Binding
    normal: np.ndarray  # (n, 3) float32
    tangent: np.ndarray


class OBJECT_OT_limit_points_add(ScatterOperator, bpy.types.Operator):
    """Scatter points over the active mesh's limit surface: vertices that carry the surface's
    normal, tangent and rotation, and optionally an instance of an object on each"""

    bl_idname = ids.POINTS_ADD
    bl_label = "Add Points on Limit Surface"
    noun = "points"

    instance: StringProperty(
        name="Instance",
        description="Name of an object to put on each point, with its Z axis along the surface "
        "normal and its X axis along growing u",
    )

    def check_properties(self) -> None:
        if self.instance and self.instance not in bpy.data.objects:
            raise RefusalError(f"There is no object {self.instance!r} to put on the points")

    def draw_own(self, layout: bpy.types.UILayout) -> None:
        layout.prop_search(self, "instance", bpy.data, "objects")

    def maker(self, _found: cage.Cage) -> Callable[[Ground, Progress], Points]:
        def make(ground: Ground, progress: Progress) -> Points:
            count = len(ground.locations)
            binding = Binding(ground.locations)
            normal, tangent = (np.empty((count, 3), np.float32) for _ in range(2))
            for part in roots.evaluate(ground.evaluate, ground.locations, progress):
                binding.fill(part)
                tangent[part.rows] = part.frame[:, :, 0]
                normal[part.rows] = part.frame[:, :, 2]
            return Points(binding, normal, tangent)

        return make

    def add(
        self, context: bpy.types.Context, surface: bpy.types.Object, made: Points
    ) -> bpy.types.Object:
        mesh = bpy.data.meshes.new(ids.POINTS_OBJECT)
        try:
            mesh.vertices.add(len(made.normal))
            attributes.write(mesh, "position", "FLOAT_VECTOR", "POINT", made.binding.root)
            made.binding.write(mesh, "POINT")
            attributes.write(mesh, ids.NORMAL, "FLOAT_VECTOR", "POINT", made.normal)
            attributes.write(mesh, ids.TANGENT, "FLOAT_VECTOR", "POINT", made.tangent)
            attributes.write(mesh, ids.ROTATION, "QUATERNION", "POINT", made.binding.rotation)
            mesh.update()
            ob = add_on_surface(context, ids.POINTS_OBJECT, mesh, surface)
            if self.instance:
                put_instances(ob, bpy.data.objects[self.instance])
            return ob
        except BaseException:
            bpy.data.meshes.remove(mesh)
            raise
