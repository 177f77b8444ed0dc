# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_points_add."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatProperty, StringProperty

from .. import ids, native
from ..errors import RefusalError
from ..nodes import instances
from ..nodes.scales import put_scales
from ..placing import roots
from ..placing.binding import Binding
from ..placing.distribution_properties import DENSITY, surface_object
from ..placing.new_objects import add_on_surface
from ..placing.rotations import WorldSpace
from ..placing.scatter_operator import Ground, ScatterOperator
from ..reading import attributes, cage
from ..reading.named import find_object
from ..sources import steering
from ..sources.index import IndexChoice
from ..sources.source_mesh import Choice
from ..tasks.job import Progress
from ..tasks.object_keys import CollectionKey, ObjectKey
from . import posing
from .orientation import Poser
from .steering import INDEX, STEERED, SteeringProperties, draw


@dataclass(frozen=True)
class Points:
    binding: Binding
    normal: np.ndarray  # (n, 3) float32
    tangent: np.ndarray
    rotation: np.ndarray  # (n, 4) float32
    scale: np.ndarray  # (n,) float32
    member: np.ndarray | None  # (n,) int32, of the collection
    world_scale: float  # how much larger things are in the world than in the object's space


class OBJECT_OT_limit_points_add(ScatterOperator, SteeringProperties, bpy.types.Operator):
    """Scatter points over the active mesh's limit surface. Each can show an instance of an object
    or of a collection's member, or a scale, and stores its rotation and the surface's normal"""

    bl_idname = ids.POINTS_ADD
    bl_label = "Add Points on Limit Surface"
    noun = "points"

    # that of which instances are put on the points
    _shown: ObjectKey | CollectionKey | None = None

    instances: EnumProperty(
        name="Instances",
        description="What stands on each point",
        items=(
            ("OBJECT", "Object", "Put an instance of an object on each point, if one is named", 0),
            ("SCALE", "Scale", "Put a scale, like that of a fish, on each point", 1),
            (
                "COLLECTION",
                "Collection",
                "Put an instance of one of a collection's members on each point",
                2,
            ),
        ),
        default="OBJECT",
    )
    instance: StringProperty(
        name="Instance",
        description="Name of an object to put on each point. Its Z axis points along the surface "
        "normal, and its X axis along u of the face, on a quad from its first corner to its second "
        "one. Along a border, its Z axis has the chosen direction and its Y axis runs along the "
        "border",
    )
    collection: StringProperty(
        name="Collection",
        description="Name of the collection whose objects and child collections stand on the "
        "points. They are counted in the order of their names",
    )
    scale_length: FloatProperty(
        name="Scale Length",
        description="Length of the scales in world units. Their width, lift, turn and material "
        "are inputs of the modifier Limit Scales",
        default=0.15,
        min=0.0,
        soft_max=10.0,
        precision=4,
        subtype="DISTANCE",
    )

    def check_properties(self) -> None:
        self._shown = None
        if self.instances == "OBJECT" and self.instance:
            found = find_object(self.instance, "the object to put on the points")
            self._shown = ObjectKey.of(found)
        if self.instances == "COLLECTION":
            found = bpy.data.collections.get(self.collection)
            self._shown = found and CollectionKey.of(found)
            if not self.collection:
                raise RefusalError("Choose the collection to put on the points")
            if found is None:
                raise RefusalError(
                    f"There is no collection {self.collection!r} to put on the points"
                )
            if not posing.size_of(found):
                raise RefusalError(f"The collection {found.name} is empty")

    def sources(self) -> Mapping[str, Choice]:
        found = steering.choices(self.properties, bpy.context, STEERED)
        if self.instances == "COLLECTION":
            found[posing.MEMBERS] = IndexChoice.of(INDEX.choice(self.properties))
        return found

    @staticmethod
    def draw_own(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
        surface = surface_object(properties, bpy.context)
        layout.prop(properties, "instances")
        images = dict(STEERED)
        if properties.instances == "SCALE":
            layout.prop(properties, "scale_length")
        elif properties.instances == "COLLECTION":
            layout.prop_search(properties, "collection", bpy.data, "collections")
            INDEX.draw(layout, properties, surface)
            images[posing.MEMBERS] = INDEX
        else:
            layout.prop_search(properties, "instance", bpy.data, "objects")
        draw(layout, properties, surface)
        steering.draw_image_place(layout, properties, surface, images, DENSITY.source)

    def maker(self, found: cage.Cage) -> Callable[[Ground, Progress], Points]:
        space, settings = WorldSpace(found.matrix, found.name), posing.Settings.of(self)

        def make(ground: Ground, progress: Progress) -> Points:
            count, poser = len(ground.locations), Poser(settings.seed)
            posed = posing.Posed(ground, space, settings)
            binding = Binding(ground.locations)
            normal, tangent = (np.empty((count, 3), np.float32) for _ in range(2))
            rotation = np.empty((count, 4), np.float32)
            scale = np.empty(count, np.float32)
            for part in roots.evaluate(ground.evaluate, ground.locations, progress):
                binding.fill(part)
                frame, pose = ground.frames(part, space), posed.of(part.rows)
                tangent[part.rows] = frame[:, :, 0]
                normal[part.rows] = frame[:, :, 2]
                rotation[part.rows] = native.limitsurf.quaternions(poser.turned(frame, pose))
                scale[part.rows] = poser.scales(pose, len(frame))[:, 0]
            members = posed.members()
            return Points(binding, normal, tangent, rotation, scale, members, space.mean_scale)

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
            attributes.write(mesh, ids.SCALE, "FLOAT", "POINT", made.scale)
            if made.member is not None:
                attributes.write(mesh, ids.MEMBER, "INT", "POINT", made.member)
            mesh.update()
            shown = self._shown.find() if self._shown else None
            ob = add_on_surface(context, ids.POINTS_OBJECT, mesh, surface, shown)
            if self.instances == "SCALE":
                put_scales(ob, self.scale_length / made.world_scale)
            elif self.instances == "COLLECTION":
                instances.put_members(ob, shown)
            elif shown:
                instances.put_instances(ob, shown)
            return ob
        except BaseException:
            bpy.data.meshes.remove(mesh)
            raise
