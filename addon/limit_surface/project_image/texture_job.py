# SPDX-License-Identifier: GPL-3.0-or-later
"""Painting into a texture: what is asked for, the work on arrays, and the image that is changed."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..errors import RefusalError
from ..images import (
    image_names,
    image_pixels,
    material_slots,
    overlap,
    texel_places,
    uv_tiles,
)
from ..tasks.job import Progress, part_of
from ..tasks.object_keys import ImageKey, ObjectKey
from . import colours, inputs, material
from .painting import Canvas, paint
from .sources import Source
from .world import WorldSurface

if TYPE_CHECKING:
    import limitsurf

MAPPED = 0.4  # the part of a tile's progress at which its texels are known


@dataclass(frozen=True)
class NewImage:
    name: str
    width: int
    height: int
    is_float: bool


@dataclass(frozen=True)
class Order:
    surface: ObjectKey
    world: WorldSurface
    uv_map: limitsurf.SurfaceData
    source: Source
    image: str
    target: ImageKey | NewImage
    canvases: dict[int, Canvas]  # pixels by tile
    sums: dict[int, int]  # checksums of the pixels of an image that exists, by tile
    margin: int
    allow_overlap: bool
    opacity: float
    create_material: bool

    def work(self, progress: Progress) -> Made:
        self.source.check()
        count, overlapping, whole = 0, 0, len(self.canvases)
        is_covered, is_reached, changed = False, False, []
        for i, (tile, canvas) in enumerate(self.canvases.items()):
            part = part_of(progress, i / whole, (i + 1) / whole)
            texels = texel_places.texels(
                self.uv_map,
                canvas.size,
                tile,
                margin=self.margin,
                allow_overlap=self.allow_overlap,
                progress=part_of(part, 0, MAPPED),
            )
            if not texels.inside.any():
                continue
            is_covered = True
            overlapping += overlap.overlapping(texels)
            painting = part_of(part, MAPPED, 1)
            painted = paint(canvas, texels, self.uv_map, self.source, self.opacity, painting)
            count += int(np.count_nonzero(painted.texels & texels.inside))
            is_reached |= painted.is_reached
            if painted.texels.any():
                changed.append(tile)
        if not is_covered:
            raise uv_tiles.no_texels(
                self.canvases, "paint into an image that has the tiles of its islands"
            )
        if not count:
            raise RefusalError(self._nothing(is_reached))
        warnings = [overlap.told(overlapping) if overlapping else "", self._outside()]
        return Made(self, count, tuple(changed), warnings)

    def _nothing(self, is_reached: bool) -> str:
        """Returns the reason why nothing was painted."""
        if is_reached:
            return f"The image {self.image} is transparent where it falls on the surface"
        reasons = f": {self.source.unreached}" if self.source.unreached else ""
        return f"No part of the image {self.image} reaches the surface{reasons}"

    def _outside(self) -> str:
        """Returns a warning about the faces outside the image's tiles, or none."""
        width, height = np.max([canvas.size for canvas in self.canvases.values()], axis=0).tolist()
        count = uv_tiles.faces_outside(self.world.cage, (width, height), self.canvases.keys())
        return uv_tiles.told(count, self.canvases.keys())


@dataclass(frozen=True)
class Made:
    order: Order
    count: int  # number of painted texels inside islands
    painted: tuple[int, ...]  # the tiles that have changed
    warnings: list[str]

    def put(self, _context: bpy.types.Context, surface: bpy.types.Object) -> tuple[str, list[str]]:
        target = self.order.target
        if isinstance(target, NewImage):
            image = image_pixels.new(
                target.name,
                target.width,
                target.height,
                is_float=target.is_float,
                is_data=False,
                alpha=True,
            )
        else:
            image = target.find()
            self._check(image)
        pixels = {tile: self.order.canvases[tile].pixels for tile in self.painted}
        image_pixels.write(image, pixels, is_new=isinstance(target, NewImage))
        warnings = [*self.warnings, image_pixels.unsaved(image)]
        if self.order.create_material:
            shown_by = material.show(surface, image, self.order.world.cage.chosen_uv_map.name)
            warnings.append(material_slots.unseen(surface, shown_by))
        return texel_places.told(image.name, self.count), warnings

    def _check(self, image: bpy.types.Image) -> None:
        """Raises RefusalError for an image that is not what was painted over any more."""
        sizes, canvases = image_pixels.checked(image, to_write=True).tiles, self.order.canvases
        if any(sizes.get(tile) != canvases[tile].size for tile in self.painted):
            raise RefusalError(
                f"The size of {image.name} has changed since the work began: run the operator again"
            )
        sums = self.order.sums
        if any(_sum(image_pixels.read(image, tile)) != sums[tile] for tile in self.painted):
            raise RefusalError(
                f"The pixels of {image.name} were changed meanwhile: run the operator again"
            )


def order(
    properties: bpy.types.OperatorProperties,
    context: bpy.types.Context,
    world: WorldSurface,
    surface: bpy.types.Object,
) -> Order:
    if not properties.opacity:
        raise RefusalError("Opacity is 0, so the image would be invisible")
    if properties.create_material:
        material.check(surface)
    shown = inputs.image(properties.image)
    target = _target(properties)
    canvases = _canvases(target, properties.allow_large)
    is_new = isinstance(target, NewImage)
    return Order(
        surface=ObjectKey.of(surface),
        world=world,
        uv_map=texel_places.uv_data(world.surface, world.cage, surface.name),
        source=inputs.source(properties, context, world, shown),
        image=shown.name,
        target=target,
        canvases=canvases,
        sums={} if is_new else {tile: _sum(of.pixels) for tile, of in canvases.items()},
        margin=properties.margin,
        allow_overlap=properties.overlap == "ALLOW",
        opacity=properties.opacity,
        create_material=properties.create_material,
    )


def _sum(pixels: np.ndarray) -> int:
    return zlib.crc32(np.ascontiguousarray(pixels).data)


def _target(properties: bpy.types.OperatorProperties) -> ImageKey | NewImage:
    if properties.output == "NEW":
        name = properties.target or image_names.with_ending(properties.image, " Projected")
        return NewImage(name, properties.width, properties.height, properties.use_float)
    if not properties.target:
        raise RefusalError("Choose an image to paint into")
    if properties.target not in bpy.data.images:
        raise RefusalError(f"There is no image {properties.target!r} to paint into")
    if properties.target == properties.image:
        raise RefusalError(f"The image {properties.image} cannot be painted into itself")
    return ImageKey.of(bpy.data.images[properties.target])


def _canvases(target: ImageKey | NewImage, allow_large: bool) -> dict[int, Canvas]:
    if isinstance(target, NewImage):
        texel_places.check_size(target.width, target.height, 1, 1, allow_large)
        blank = np.zeros((target.height, target.width, 4), np.float32)
        return {image_pixels.FIRST_TILE: Canvas(blank, colours.of_new(target.is_float))}
    image = target.find()
    tiles = image_pixels.checked(image, to_write=True).tiles
    encoding = colours.of(image)
    return {tile: Canvas(image_pixels.read(image, tile), encoding) for tile in tiles}
