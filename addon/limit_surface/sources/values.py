# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers over a surface, from vertex groups, images and attributes, within a range.

They are read from the cage's mesh after its modifiers, and stored as arrays.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..errors import RefusalError
from ..reading import attributes, rules
from . import image_map
from .channels import pick
from .image_map import ImageMap
from .source_mesh import SourceMesh, color_attribute, vertex_group

if TYPE_CHECKING:
    import bpy
    import limitsurf

#: The number of squares of which bounds are known, roughly, and the most along a face
SQUARES = 1 << 15
MOST_PER_SIDE = 64

_COLORS = {"FLOAT_COLOR", "BYTE_COLOR"}
_NUMBERS = {"FLOAT", "INT", "INT8", "BOOLEAN", *_COLORS}


@dataclass(frozen=True)
class Values:
    """The numbers of a source on a surface: `low` where the source is 0, `high` where it is 1, and
    on the straight line through both elsewhere.
    """

    source: ValueMap
    surface: limitsurf.LimitSurface
    data: limitsurf.SurfaceData | None  # None: a value a face

    def __call__(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Returns the numbers (n,) at Ptex faces (n,) and uv (n, 2)."""
        if self.data is None:
            return self.source.in_range(self.source.values[:, 0])[self.surface.base_face[face]]
        value = self.data.evaluate(face, uv).value
        image = self.source.image
        return self.source.in_range(image.at(value) if image else value[:, 0])

    def upper_bounds(self) -> np.ndarray:
        """Returns numbers that are not exceeded on n x n equal squares of each Ptex face,
        (f, n, n), where n is a power of two; NaN where there is no surface.
        """
        if self.data is None:
            return self(np.arange(self.surface.face_count), np.empty(0))[:, None, None]
        per_side = 1
        while per_side < MOST_PER_SIDE and self.surface.face_count * 4 * per_side**2 <= SQUARES:
            per_side *= 2
        boxes = self.data.bounds(per_side)  # (f, n, n, 2, columns)
        image = self.source.image
        both = image.bounds(boxes.reshape(-1, 2, 2)) if image else boxes
        return self.source.in_range(both.reshape(*boxes.shape[:4])).max(axis=-1)


@dataclass(frozen=True)
class ValueMap:
    """The numbers that a source holds, or the UV coordinates at which its image is read."""

    values: np.ndarray  # (m, 1), or (m, 2) UV coordinates
    indices: np.ndarray | None  # for each face corner the row of its value; None: a row a face
    interpolation: rules.Interpolation
    image: ImageMap | None
    low: float
    high: float

    def on(self, surface: limitsurf.LimitSurface) -> Values:
        if self.indices is None:
            return Values(self, surface, None)
        data = surface.face_varying(self.values, self.indices, self.interpolation)
        return Values(self, surface, data)

    @property
    def largest(self) -> float:
        """The largest number anywhere, beside what a clipped image gives outside."""
        return self.in_range(self.image.values if self.image else self.values).max(initial=-np.inf)

    def in_range(self, values: np.ndarray) -> np.ndarray:
        return self.low + (self.high - self.low) * values


@dataclass(frozen=True)
class ValueChoice:
    """The choice of a source. Its errors begin with `label`, which says what it is for. Where no
    vertex group, color attribute or UV map is named, the active one of the object is used.
    """

    label: str
    source: str  # NONE, VERTEX_GROUP, IMAGE, ATTRIBUTE or COLOR_ATTRIBUTE
    vertex_group: str = ""
    image: str = ""
    uv_map: str = ""
    attribute: str = ""
    channel: str = "LUMINANCE"
    extension: str = "REPEAT"
    low: float = 0.0
    high: float = 1.0

    def wanted_vertex_groups(self, ob: bpy.types.Object) -> list[str]:
        if self.source != "VERTEX_GROUP":
            return []
        with labelled(self.label):
            return [vertex_group(ob, self.vertex_group)]

    def read(self, mesh: SourceMesh) -> ValueMap | None:
        """Returns the values, or None where no source is chosen. Raises RefusalError where the
        source does not exist, or holds no numbers.
        """
        if self.source == "NONE":
            return None
        with labelled(self.label):
            if self.source == "IMAGE":
                return self._of_image(mesh)
            if self.source == "VERTEX_GROUP":
                values, indices = self._of_vertex_group(mesh)
            else:
                values, indices = self._of_attribute(mesh)
        column = values.astype(np.float64)[:, None]
        return ValueMap(column, indices, rules.LINEAR, None, self.low, self.high)

    def _of_vertex_group(self, mesh: SourceMesh) -> tuple[np.ndarray, np.ndarray | None]:
        name = vertex_group(mesh.ob, self.vertex_group)
        values = mesh.weights[name]
        if values is None:
            raise RefusalError(f"{mesh.ob.name}: the modifiers remove the vertex group {name}")
        return values, mesh.cage.mesh.face_vertices

    def _of_attribute(self, mesh: SourceMesh) -> tuple[np.ndarray, np.ndarray | None]:
        name = self.attribute
        if self.source == "COLOR_ATTRIBUTE":
            name = color_attribute(mesh.ob, name)
            _check_is_color(mesh, name)
        found = mesh.find_attribute(name)
        if found.data_type not in _NUMBERS or found.domain == "EDGE":
            raise RefusalError(
                f"The attribute {name} is {found.data_type} on {found.domain}: numbers or colors "
                "of vertices, face corners or faces are needed"
            )
        values = attributes.read(mesh.mesh, name)
        if found.data_type in _COLORS:
            values = pick(values, self.channel, f"color attribute {name}")
        if not np.isfinite(values).all():
            raise RefusalError(f"The attribute {name} has values that are not finite numbers")
        if found.domain == "FACE":
            return values, None
        is_of_corners = found.domain == "CORNER"
        return values, np.arange(len(values)) if is_of_corners else mesh.cage.mesh.face_vertices

    def _of_image(self, mesh: SourceMesh) -> ValueMap:
        image = image_map.find(self.image)
        placed = mesh.find_uv_map(self.uv_map, self.image)
        values = pick(image_map.pixels(image), self.channel, f"image {image.name}")
        return ValueMap(
            placed.values,
            placed.indices,
            mesh.cage.rules.uv_interpolation,
            ImageMap(values, self.extension),
            self.low,
            self.high,
        )


def _check_is_color(mesh: SourceMesh, name: str) -> None:
    ob = mesh.ob
    if name not in mesh.mesh.color_attributes:
        if name in ob.data.color_attributes:
            raise RefusalError(f"{ob.name}: the modifiers remove the color attribute {name}")
        raise RefusalError(f"{ob.name} has no color attribute {name!r}")


@contextmanager
def labelled(label: str) -> Iterator[None]:
    """Begins the messages of refusals with a label, if there is one."""
    try:
        yield
    except RefusalError as error:
        if not label:
            raise
        raise RefusalError(f"{label}: {error}") from error
