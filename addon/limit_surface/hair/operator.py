# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_hair_add."""

from collections.abc import Callable, Mapping

import bpy
import numpy as np
from bpy.props import FloatProperty, FloatVectorProperty, IntProperty

from .. import ids
from ..placing import new_hair, roots
from ..placing.binding import Binding
from ..placing.distribution_properties import DENSITY, surface_object
from ..placing.new_hair import Strands
from ..placing.rotations import WorldSpace
from ..placing.scatter_operator import Ground, ScatterOperator
from ..reading import cage
from ..sources import steering
from ..sources.source_mesh import Choice
from ..tasks.job import Progress
from .steering import SIGNED, STEERED, SteeringProperties, draw
from .strands import Shape, StrandMaker


class OBJECT_OT_limit_hair_add(ScatterOperator, SteeringProperties, bpy.types.Operator):
    """Grow hair on the active mesh's limit surface: each root lies exactly on the smooth surface
    that infinitely many subdivisions of the mesh approach"""

    bl_idname = ids.HAIR_ADD
    bl_label = "Add Hair on Limit Surface"
    noun = "strands"

    length: FloatProperty(
        name="Length",
        description="Length of the strands in world units, independent of the object's scale",
        default=0.1,
        min=0.0,
        soft_max=10.0,
        subtype="DISTANCE",
    )
    points: IntProperty(
        name="Points",
        description="Number of control points on each strand, including the root",
        default=5,
        min=2,
        max=1024,
        soft_max=32,
    )
    tilt: FloatVectorProperty(
        name="Tilt",
        description="Angles by which strands lean away from the surface normal, towards u and "
        "towards v of their face. On a quad, u runs from its first corner to its second one, and v "
        "from its first to its last. Along a border, the first angle turns strands outwards, and "
        "the second one along the border",
        size=2,
        default=(0.0, 0.0),
        min=-np.pi,
        max=np.pi,
        unit="ROTATION",
    )
    random: FloatProperty(
        name="Random",
        description="Largest random angle by which each strand leans in addition, in a random "
        "direction",
        default=0.0,
        min=0.0,
        max=np.pi,
        unit="ROTATION",
    )
    radius: FloatProperty(
        name="Radius",
        description="Radius of the strands in world units",
        default=0.001,
        min=0.0,
        soft_max=0.1,
        precision=4,
        subtype="DISTANCE",
    )

    def elements_per_location(self) -> int:
        return self.points

    def sources(self) -> Mapping[str, Choice]:
        return steering.choices(self.properties, bpy.context, STEERED)

    @staticmethod
    def draw_own(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
        surface = surface_object(properties, bpy.context)
        draw(layout, properties, surface)
        steering.draw_image_place(layout, properties, surface, STEERED, DENSITY.source)

    def maker(self, found: cage.Cage) -> Callable[[Ground, Progress], Strands]:
        space = WorldSpace(found.matrix, found.name)
        length, points, tilt = self.length, self.points, np.array(self.tilt)
        random, random_length = self.random, self.random_length
        flow_angle = self.flow_angle
        seed, radius = self.seed, self.radius / space.mean_scale
        uv_map = found.uv_map.name if found.uv_map else ""

        def make(ground: Ground, progress: Progress) -> Strands:
            region = ground.region
            maker = StrandMaker(space, seed, random > 0, random_length > 0)
            steered = steering.Steering(
                region.sources, region.cage, region.surface, STEERED, SIGNED
            )
            at = ground.locations
            flow = steered.flow(at.face, at.uv.astype(np.float64))
            binding = Binding(ground.locations)
            position = np.empty((len(ground.locations), points, 3), np.float32)
            radii = np.empty(len(ground.locations), np.float32)
            for part in roots.evaluate(ground.evaluate, ground.locations, progress):
                binding.fill(part)
                frame = ground.world_frames(part, space)
                uv = at.uv[part.rows].astype(np.float64)
                factors = steered.factors(at.face[part.rows], uv)
                lean = tilt * factors["tilt"]
                if flow is not None:
                    sideways = np.einsum("nij,ni->nj", frame[:, :, :2], flow[part.rows])
                    lean = lean + flow_angle * sideways
                shape = Shape(
                    length=length * factors["length"],
                    lean=lean,
                    random=random * factors["random"],
                    random_length=(random_length * factors["random"]).clip(max=1),
                )
                maker.put(position[part.rows], part.position, frame, shape)
                radii[part.rows] = radius * factors["radius"][:, 0]
            return Strands.equal(binding, position, radii, ground.surface_uv(), uv_map)

        return make

    def add(
        self, context: bpy.types.Context, surface: bpy.types.Object, made: Strands
    ) -> bpy.types.Object:
        return new_hair.add(context, ids.HAIR_OBJECT, surface, made)
