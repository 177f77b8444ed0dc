# SPDX-License-Identifier: GPL-3.0-or-later
"""The making of a decal: what is asked for, the work on arrays, and the resulting object."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..counting import counted
from ..errors import RefusalError
from ..placing import following
from ..reading.projector import Projector, fitted
from ..tasks.job import Progress, part_of
from ..tasks.object_keys import ImageKey, ObjectKey
from ..tasks.request_size import RequestSize
from . import decal, decal_object, inputs, material
from .world import WorldSurface

CAST = 0.9  # the part of the progress at which the polygons are known


@dataclass(frozen=True)
class Order:
    surface: ObjectKey
    world: WorldSurface
    projector: Projector
    image: ImageKey
    quads: tuple[int, int]
    steepest: float
    two_sided: bool
    offset: float
    create_material: bool
    binding: following.Request | None  # None: the decal does not follow the surface

    def work(self, progress: Progress) -> Made:
        self.world.check_eye(self.projector)
        rays = decal.Rays(self.world, self.projector, self.steepest, self.two_sided)
        found = decal.make(rays, self.quads, part_of(progress, 0, CAST))
        if not len(found.sizes):
            raise RefusalError(
                "The image cannot be seen on the surface: no part of the image "
                f"{self.image.name} falls on the surface, or only parts smaller than a polygon of "
                "the decal (raise Resolution then)"
            )
        sag = decal.sag(rays, found)
        placing = part_of(progress, CAST, 1)
        placed = decal_object.PlacedDecal(self.world, found, self.offset, placing)
        bindings = self.binding.compute(placed.locations) if self.binding else None
        return Made(self, placed, sag, bindings)


@dataclass(frozen=True)
class Made:
    order: Order
    placed: decal_object.PlacedDecal
    sag: float  # the distance of polygons below the surface, without the offset
    bindings: following.Bindings | None

    @property
    def warning(self) -> str:
        if self.sag <= self.order.offset:
            return ""
        return (
            f"Polygons lie up to {self.sag - self.order.offset:.2g} below the surface: raise the "
            f"resolution, or the offset to {1.1 * self.sag:.2g}"
        )

    def put(self, context: bpy.types.Context, surface: bpy.types.Object) -> tuple[str, list[str]]:
        image = self.order.image.find()
        made = decal_object.add(context, ids.DECAL_OBJECT, self.placed, surface)
        if self.order.create_material:
            material.for_decal(made, image, ids.DECAL_UV)
        if self.bindings:
            self.bindings.write(made)
        text = f"{counted(len(self.placed.sizes), 'polygons')} on {surface.name}"
        if self.bindings:
            text += "; they follow the surface by Geometry Nodes"
        return text, [self.warning]


def order(
    properties: bpy.types.OperatorProperties,
    context: bpy.types.Context,
    world: WorldSurface,
    surface: bpy.types.Object,
) -> Order:
    image = inputs.image(properties.image)
    size = tuple(image.size)
    # Quads are as square as possible with whole numbers of columns and rows.
    columns, rows = np.rint(properties.decal_resolution * fitted(size)).clip(1).astype(int).tolist()
    RequestSize("polygons", columns * rows, 1).check(properties.allow_large)
    return Order(
        surface=ObjectKey.of(surface),
        world=world,
        projector=inputs.projector(properties, context, world, size),
        image=ImageKey.of(image),
        quads=(columns, rows),
        steepest=inputs.facing(properties)[1],
        two_sided=properties.two_sided,
        offset=properties.decal_offset,
        create_material=properties.create_material,
        binding=following.request_for(
            properties.follow, surface, context.evaluated_depsgraph_get()
        ),
    )
