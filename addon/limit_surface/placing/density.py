# SPDX-License-Identifier: GPL-3.0-or-later
"""Densities over a surface, from vertex groups, images and colour attributes.

They are read from the cage's mesh after its modifiers, and stored as arrays.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import attributes, cage, rules, uv_map, vertex_weights
from ..reading.uv_map import UvMap
from .channels import pick
from .image_map import ImageMap
from .image_map import read as read_image

if TYPE_CHECKING:
    import limitsurf

#: A function from Ptex faces (n,) and uv (n, 2) to densities (n,), all at least 0
Density = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class DensityMap:
    """Values to which the face corners refer: densities, or UV coordinates if there is an image."""

    values: np.ndarray  # (m, 1), or (m, 2) UV coordinates
    indices: np.ndarray  # for each face corner the row of its value
    interpolation: rules.Interpolation
    image: ImageMap | None
    invert: bool

    def on(self, surface: limitsurf.LimitSurface) -> Density:
        data = surface.face_varying(self.values, self.indices, self.interpolation)

        def density(face: np.ndarray, uv: np.ndarray) -> np.ndarray:
            value = data.evaluate(face, uv).value
            found = self.image.at(value) if self.image else value[:, 0]
            return np.maximum(1 - found if self.invert else found, 0)

        return density


@dataclass(frozen=True)
class DensityChoice:
    source: str  # NONE, VERTEX_GROUP, IMAGE or COLOR_ATTRIBUTE
    vertex_group: str
    image: str
    uv_map: str
    color_attribute: str
    channel: str
    extension: str
    invert: bool

    def wanted_vertex_groups(self, ob: bpy.types.Object) -> list[str]:
        if self.source != "VERTEX_GROUP":
            return []
        if self.vertex_group not in ob.vertex_groups:
            raise RefusalError(f"{ob.name} has no vertex group {self.vertex_group!r}")
        if self.vertex_group in ob.data.attributes:
            raise RefusalError(
                f"{ob.name} has an attribute with the same name as the vertex group "
                f"{self.vertex_group}, which hides the group: rename the group"
            )
        return [self.vertex_group]

    def read(
        self, mesh: bpy.types.Mesh, found: cage.Cage, ob: bpy.types.Object
    ) -> DensityMap | None:
        """Reads the density from the cage's mesh. Raises RefusalError where the source does not
        exist, or is 0 everywhere.
        """
        if self.source == "NONE":
            return None
        if self.source == "IMAGE":
            return self._of_image(mesh, found, ob)
        if self.source == "VERTEX_GROUP":
            values, indices = self._of_vertex_group(mesh, found, ob)
        else:
            values, indices = self._of_colours(mesh, found, ob)
        self._check(values)
        return DensityMap(values[:, None], indices, rules.LINEAR, None, self.invert)

    def _of_vertex_group(
        self, mesh: bpy.types.Mesh, found: cage.Cage, ob: bpy.types.Object
    ) -> tuple[np.ndarray, np.ndarray]:
        (values,) = vertex_weights.read(mesh, 1)
        if values is None:
            raise RefusalError(
                f"{ob.name}: the modifiers remove the vertex group {self.vertex_group}"
            )
        return values.astype(np.float64), found.mesh.face_vertices

    def _of_colours(
        self, mesh: bpy.types.Mesh, found: cage.Cage, ob: bpy.types.Object
    ) -> tuple[np.ndarray, np.ndarray]:
        name = self.color_attribute
        layer = mesh.color_attributes.get(name)
        if layer is None:
            if name in ob.data.color_attributes:
                raise RefusalError(f"{ob.name}: the modifiers remove the color attribute {name}")
            raise RefusalError(f"{ob.name} has no color attribute {name!r}")
        colours = attributes.read(mesh, name)
        values = pick(colours, self.channel, f"color attribute {name}").astype(np.float64)
        corner = layer.domain == "CORNER"
        return values, np.arange(len(values)) if corner else found.mesh.face_vertices

    def _of_image(self, mesh: bpy.types.Mesh, found: cage.Cage, ob: bpy.types.Object) -> DensityMap:
        image = bpy.data.images.get(self.image)
        if image is None:
            raise RefusalError(f"There is no image {self.image!r}")
        placed = self._find_uv_map(mesh, found, ob)
        pixels = read_image(image, self.channel, self.extension)
        if self.extension != "CLIP":  # otherwise places outside the image have a density, too
            self._check(pixels.values)
        return DensityMap(
            placed.values, placed.indices, found.rules.uv_interpolation, pixels, self.invert
        )

    def _find_uv_map(self, mesh: bpy.types.Mesh, found: cage.Cage, ob: bpy.types.Object) -> UvMap:
        if not self.uv_map:
            if found.uv_map is None:
                why = found.without_uv_map or f"{ob.name} has no UV map"
                raise RefusalError(f"The image {self.image} cannot be placed: {why}")
            return found.uv_map
        if self.uv_map not in mesh.uv_layers:
            raise RefusalError(f"{ob.name} has no UV map {self.uv_map!r} where it is subdivided")
        if not np.isfinite(attributes.read(mesh, self.uv_map)).all():
            raise RefusalError(
                f"The UV map {self.uv_map} has coordinates that are not finite numbers"
            )
        return uv_map.read(mesh, self.uv_map)

    def _check(self, values: np.ndarray) -> None:
        if not ((1 - values if self.invert else values) > 0).any():
            raise RefusalError("The density is 0 everywhere")
