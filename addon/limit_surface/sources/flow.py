# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions over a surface into which strands are combed: images, attributes, curves, curvature.

A flow is read from the cage's mesh after its modifiers. It is evaluated in the world.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ..errors import RefusalError
from ..reading import attributes, rules
from ..reading.cage import Cage
from ..reading.uv_map import UvMap
from . import image_map
from .image_map import ImageMap
from .source_mesh import SourceMesh
from .values import labelled

if TYPE_CHECKING:
    import bpy

#: A function from Ptex faces (n,) and uv (n, 2) to vectors (n, 3) in the world: tangents of the
#: surface, at most 1 long. It is called once for all locations.
Directions = Callable[[np.ndarray, np.ndarray], np.ndarray]

# Principal directions are axes without a head. The head is where this vector points: downwards,
# but for level directions, for which the small numbers decide.
_DOWN = np.array([0.02, 0.01, -1.0])
# curvatures that differ by less than this, times the surface's size, have no directions
_SAME_CURVATURE = 1e-6


class Flow(Protocol):
    def on(self, found: Cage) -> Directions:
        """Returns the directions over the surface of a cage. Blender's data is not touched."""


@dataclass(frozen=True)
class CombMap:
    """An image whose red is the part along the map's U, and whose green is that along V."""

    placed: UvMap
    interpolation: rules.Interpolation
    image: ImageMap  # (height, width, 2), from 0 to 1

    def on(self, found: Cage) -> Directions:
        surface = found.surface(in_world=True)
        placed = surface.face_varying(self.placed.values, self.placed.indices, self.interpolation)

        def at(face: np.ndarray, uv: np.ndarray) -> np.ndarray:
            combed = 2 * self.image.at(placed.evaluate(face, uv).value) - 1
            frames = surface.tangent_frames(placed, face, uv)
            return _shortened(np.einsum("nij,nj->ni", frames[:, :, :2], combed))

        return at


@dataclass(frozen=True)
class VectorMap:
    """Vectors in the object's space, of which the tangential part counts."""

    values: np.ndarray  # (m, 3)
    domain: str  # POINT, CORNER or FACE

    def on(self, found: Cage) -> Directions:
        surface, linear = found.surface(), found.matrix[:3, :3]
        if self.domain == "POINT":
            data = surface.vertex_data(self.values)
        elif self.domain == "CORNER":
            data = surface.face_varying(self.values, np.arange(len(self.values)), rules.LINEAR)

        def at(face: np.ndarray, uv: np.ndarray) -> np.ndarray:
            if self.domain == "FACE":
                vectors = self.values[surface.base_face[face]]
            else:
                vectors = data.evaluate(face, uv).value
            normal = surface.frames(face, uv)[:, :, 2]
            along = np.einsum("ni,ni->n", normal, vectors)
            local = _shortened(vectors - along[:, None] * normal)
            world = local @ linear.T
            return world * _divided(_lengths(local), _lengths(world))

        return at


@dataclass(frozen=True)
class Curvature:
    """The first or the second principal direction: that of the larger or the smaller curvature."""

    number: int

    def on(self, found: Cage) -> Directions:
        surface = found.surface(in_world=True)
        size = float(np.linalg.norm(np.ptp(surface.positions, axis=0)))

        def at(face: np.ndarray, uv: np.ndarray) -> np.ndarray:
            bent = surface.curvature(face, uv, irregular="average")
            axis = np.nan_to_num(bent.direction1 if self.number == 1 else bent.direction2)
            differ = np.nan_to_num((bent.k1 - bent.k2) * size) > _SAME_CURVATURE
            return axis * (np.where(axis @ _DOWN < 0, -1, 1) * differ)[:, None]

        return at


@dataclass(frozen=True)
class Curves:
    """Lines in the world, whose directions are continued over the surface."""

    name: str  # of the object, for messages
    lines: np.ndarray  # (n, 2, 3)

    def on(self, found: Cage) -> Directions:
        surface = found.surface(in_world=True)
        points = self.lines.reshape(-1, 3)
        offsets = np.arange(0, len(points) + 1, 2)

        def at(face: np.ndarray, uv: np.ndarray) -> np.ndarray:
            try:
                return surface.curve_directions(points, offsets, face, uv)
            except ValueError as error:
                raise RefusalError(f"Flow: {self.name}: {error}") from error

        return at


@dataclass(frozen=True)
class FlowChoice:
    source: str  # NONE, IMAGE, ATTRIBUTE, CURVES, CURVATURE_1 or CURVATURE_2
    image: str
    uv_map: str
    extension: str
    attribute: str
    curves: Curves | None

    def wanted_vertex_groups(self, _ob: bpy.types.Object) -> list[str]:
        return []

    def read(self, mesh: SourceMesh) -> Flow | None:
        """Returns the flow, or None where no source is chosen. Raises RefusalError where the source
        does not exist, or holds no directions.
        """
        with labelled("Flow"):
            if self.source == "IMAGE":
                return self._of_image(mesh)
            if self.source == "ATTRIBUTE":
                return self._of_attribute(mesh)
        if self.source in ("NONE", "CURVES"):
            return self.curves
        return Curvature(int(self.source[-1]))

    def _of_image(self, mesh: SourceMesh) -> CombMap:
        image = image_map.find(self.image)
        placed = mesh.find_uv_map(self.uv_map, self.image)
        pixels = image_map.pixels(image)
        if pixels.shape[2] < 2:
            raise RefusalError(f"The image {image.name} has no green channel")
        combed = np.ascontiguousarray(pixels[:, :, :2])
        if not np.isfinite(combed).all():
            raise RefusalError(f"The image {image.name} has values that are not finite numbers")
        return CombMap(placed, mesh.cage.rules.uv_interpolation, ImageMap(combed, self.extension))

    def _of_attribute(self, mesh: SourceMesh) -> VectorMap:
        name = self.attribute
        found = mesh.find_attribute(name)
        if found.data_type != "FLOAT_VECTOR" or found.domain == "EDGE":
            raise RefusalError(
                f"The attribute {name} is {found.data_type} on {found.domain}: vectors "
                "(FLOAT_VECTOR) of vertices, face corners or faces are needed"
            )
        vectors = attributes.read(mesh.mesh, name).astype(np.float64)
        if not np.isfinite(vectors).all():
            raise RefusalError(f"The attribute {name} has values that are not finite numbers")
        return VectorMap(vectors, found.domain)


def _lengths(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=1, keepdims=True)


def _divided(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.divide(a, b, out=np.zeros_like(a), where=b > 0)


def _shortened(vectors: np.ndarray) -> np.ndarray:
    """Returns the vectors, where those that are longer than 1 have that length."""
    return vectors / np.maximum(_lengths(vectors), 1)
