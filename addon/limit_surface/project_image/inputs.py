# SPDX-License-Identifier: GPL-3.0-or-later
"""The inputs of the operator: the data that its properties name, read into arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, cast

import bpy
import numpy as np

from .. import native
from ..errors import RefusalError
from ..images import image_pixels, texel_places
from ..reading import cage, camera
from ..reading.projector import Projector, fitted
from . import colours, empties, view
from .sources import AlongNormals, FromBox, FromProjector, Seen, Source
from .world import WorldSurface

if TYPE_CHECKING:
    import limitsurf

#: The enumerations of the properties, in lower case, are the words of the native module.
Extension = Literal["clip", "extend", "repeat", "mirror"]
SAMPLES: dict[str, Literal[1, 4, 16]] = {"1": 1, "4": 4, "16": 16}


def image(name: str) -> bpy.types.Image:
    """Returns the image that is projected."""
    if not name:
        raise RefusalError("Choose an image to project")
    found = bpy.data.images.get(name)
    if found is None:
        raise RefusalError(f"There is no image {name!r}")
    if list(image_pixels.checked(found).tiles) != [image_pixels.FIRST_TILE]:
        raise RefusalError(f"The image {name} is tiled (UDIM): its only tile must be 1001")
    return found


def projector(
    properties: bpy.types.OperatorProperties,
    context: bpy.types.Context,
    world: WorldSurface,
    size: tuple[int, int],
) -> Projector:
    """Returns the projector for the sources that project an image of that size from one place or
    direction.
    """
    depsgraph = context.evaluated_depsgraph_get()
    if properties.source == "CAMERA":
        ob = camera.find(context, properties.camera)
        return camera.projector(ob, depsgraph, size)
    if properties.source == "VIEW":
        return view.from_context(context, size)
    depth = tuple(properties.depth) if properties.use_depth else None
    return empties.planar(empties.find(properties.empty), depsgraph, size, world.bounds(), depth)


def source(
    properties: bpy.types.OperatorProperties,
    context: bpy.types.Context,
    world: WorldSurface,
    shown: bpy.types.Image,
) -> Source:
    size, is_framed = tuple(shown.size), properties.extension == "CLIP"
    if properties.source == "BOX":
        ob = empties.find(properties.empty)
        to_box = empties.to_box(ob, context.evaluated_depsgraph_get())
        pixels = _filtered(shown, properties.extension)
        return FromBox(world, to_box, fitted(size), pixels, properties.blend, is_framed)
    if properties.source == "NORMALS":
        return _along_normals(properties, context, world, shown)
    found = projector(properties, context, world, size)
    seen = Seen(
        facing=facing(properties),
        two_sided=properties.two_sided,
        occlusion=properties.occlusion,
        samples=SAMPLES[properties.occlusion_samples],
        soft_edge=properties.soft_edge,
        is_framed=is_framed,
    )
    # Where the frame cuts the image off, its pixels must not fade before the frame.
    extension = "EXTEND" if is_framed else properties.extension
    return FromProjector(world, found, _filtered(shown, extension), seen, _unreached(properties))


def facing(properties: bpy.types.OperatorProperties) -> tuple[float, float]:
    start, end = properties.facing
    if not start <= end:
        raise RefusalError("The angle Full Up To is larger than the angle Nothing From")
    return start, end


def _unreached(properties: bpy.types.OperatorProperties) -> str:
    """Returns why no part of the image may reach the surface, as far as the choices allow it."""
    whose = {"CAMERA": "the camera", "VIEW": "the 3D view", "PLANAR": "the empty"}
    whom, is_framed = whose[properties.source], properties.extension == "CLIP"
    found = []
    if not properties.two_sided:
        found.append(f"face away from {whom}")
    if properties.facing[1] < np.pi / 2:
        found.append("be turned away by more than Facing allows")
    if properties.source != "PLANAR":
        found.append(
            f"lie outside {whom}'s picture"
            if is_framed
            else f"lie behind {whom} or outside its clipping range"
        )
    elif is_framed or properties.use_depth:
        ends = [*["the empty's rectangle"] * is_framed, *["the depths"] * properties.use_depth]
        found.append(f"lie outside {' or '.join(ends)}")
    if properties.occlusion:
        found.append("be hidden behind other parts of itself")
    if len(found) > 1:
        found = [", ".join(found[:-1]), found[-1]]
    return f"the surface may {' or '.join(found)}" if found else ""


def _filtered(shown: bpy.types.Image, extension: str) -> limitsurf.FilteredImage:
    pixels = colours.of(shown).decoded(image_pixels.read(shown))
    if not np.isfinite(pixels).all():
        raise RefusalError(f"The image {shown.name} has values that are not finite numbers")
    return native.limitsurf.FilteredImage(pixels, cast(Extension, extension.lower()))


def _along_normals(
    properties: bpy.types.OperatorProperties,
    context: bpy.types.Context,
    world: WorldSurface,
    shown: bpy.types.Image,
) -> AlongNormals:
    name, ob = properties.from_object, bpy.data.objects.get(properties.from_object)
    if ob is None or ob.type != "MESH":
        raise RefusalError(f"There is no mesh {name!r}" if name else "No mesh is chosen")
    found = cage.read(ob, context.evaluated_depsgraph_get())
    carrier = WorldSurface(found, ob.name)
    carrier_map = texel_places.uv_data(carrier.surface, found, ob.name)
    reach = properties.max_distance or np.inf
    pixels = _filtered(shown, properties.extension)
    direction = properties.direction.lower()
    return AlongNormals(world, carrier, carrier_map, pixels, reach, direction, ob.name)
