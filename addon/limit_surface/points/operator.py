# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_points_add."""

from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatProperty, StringProperty

from .. import ids
from ..errors import RefusalError
from ..nodes.instances import put_instances
from ..nodes.scales import put_scales
from ..placing import roots
from ..placing.binding import Binding
from ..placing.new_objects import add_on_surface
from ..placing.rotations import WorldSpace, quaternions
from ..placing.scatter_operator import Ground, ScatterOperator
from ..reading import attributes, cage
from ..tasks.job import Progress


@dataclass(frozen=True)
class Points:
    binding: Binding
    normal: np.ndarray  # (n, 3) float32
    tangent: np.ndarray
    rotation: np.ndarray  # (n, 4) float32
    world_scale: float  # how much larger things are in the world than in the object's space


class OBJECT_OT_limit_points_add(ScatterOperator, bpy.types.Operator):
    """Scatter points over the active mesh's limit surface: vertices that carry the surface's
    normal, tangent and rotation, and optionally an instance of an object or a scale on each"""

    bl_idname = ids.POINTS_ADD
    bl_label = "Add Points on Limit Surface"
    noun = "points"

    instances: EnumProperty(
        name="Instances",
        description="What stands on each point",
        items=(
            ("OBJECT", "Object", "Put an instance of an object on each point, if one is named", 0),
            ("SCALE", "Scale", "Put a scale on each point, as of a fish or a lizard", 1),
        ),
        default="OBJECT",
    )
    instance: StringProperty(
        name="Instance",
        description="Name of an object to put on each point, with its Z axis along the surface "
        "normal and its X axis along growing u. Along a border, its Z axis has the chosen "
        "direction and its Y axis runs along the border",
    )
    scale_length: FloatProperty(
        name="Scale Length",
        description="Length of the scales in world units. Their width, lift and turn are inputs of "
        "the modifier Limit Scales",
        default=0.15,
        min=0.0,
        soft_max=10.0,
        precision=4,
        subtype="DISTANCE",
    )

    def check_properties(self) -> None:
        is_named = self.instances == "OBJECT" and self.instance
        if is_named and self.instance not in bpy.data.objects:
            raise RefusalError(f"There is no object {self.instance!r} to put on the points")

    @staticmethod
    def draw_own(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
        layout.prop(properties, "instances")
        if properties.instances == "SCALE":
            layout.prop(properties, "scale_length")
        else:
            layout.prop_search(properties, "instance", bpy.data, "objects")

    def maker(self, found: cage.Cage) -> Callable[[Ground, Progress], Points]:
        space = WorldSpace(found.matrix)

        def make(ground: Ground, progress: Progress) -> Points:
            count = len(ground.locations)
            binding = Binding(ground.locations)
            normal, tangent = (np.empty((count, 3), np.float32) for _ in range(2))
            rotation = np.empty((count, 4), np.float32)
            for part in roots.evaluate(ground.evaluate, ground.locations, progress):
                binding.fill(part)
                frame = ground.frames(part, space)
                tangent[part.rows] = frame[:, :, 0]
                normal[part.rows] = frame[:, :, 2]
                rotation[part.rows] = quaternions(frame)
            return Points(binding, normal, tangent, rotation, space.mean_scale)

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
            attributes.write(mesh, ids.ROTATION, "QUATERNION", "POINT", made.rotation)
            mesh.update()
            ob = add_on_surface(context, ids.POINTS_OBJECT, mesh, surface)
            if self.instances == "SCALE":
                put_scales(ob, self.scale_length / made.world_scale)
            elif self.instance:
                put_instances(ob, bpy.data.objects[self.instance])
            return ob
        except BaseException:
            bpy.data.meshes.remove(mesh)
            raise
