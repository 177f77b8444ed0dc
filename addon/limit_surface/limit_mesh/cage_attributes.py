# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of a cage, carried over to its tessellation.

They are interpolated as by Blender's Subdivision Surface: numbers, vectors and colours are linear
on each part of a face, UV maps follow the modifier's rule, the parts of a face take the face's
value, and the parts of an edge take the edge's. Types that cannot be mixed (integers, Booleans,
rotations) take the value of the nearest vertex or corner.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np

from .. import ids
from ..placing.places import ROOT_KINDS, root_attributes
from ..reading import attributes, ragged_rows, rules, uv_map
from ..tasks.job import Progress
from .places import CageElements

if TYPE_CHECKING:
    import limitsurf

LINEAR = ("FLOAT", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR")
SEAM_BEFORE_5 = ".uv_seam"
#: Attributes that are made with the new mesh, or by its normals, or for what follows the surface
_OWN = (
    "position",
    "custom_normal",
    "sharp_face",
    ids.CAGE_POSITION,
    ids.CAGE_COUNT,
    ids.CAGE_TOPOLOGY,
    ids.CAGE_EDGE_CREASES,
    ids.CAGE_VERTEX_CREASES,
)
#: What follows another surface stores these at its points. They mean nothing on the new mesh.
_OF_FOLLOWERS = (ids.TILE, ids.TILE_UV, ids.SEAL, ids.LIVE_FINGERPRINT)
# Rows are evaluated in parts of this size, so that progress is shown and memory stays small.
_PART = 1 << 18


class Attribute(NamedTuple):
    name: str
    kind: str
    domain: str
    values: np.ndarray  # one row per element of the domain


@dataclass
class CageAttributes:
    """The attributes of a cage, and the reasons why some of them cannot be carried over."""

    attributes: list[Attribute] = field(default_factory=list)
    uv_maps: list[uv_map.UvMap] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    corner_edge: np.ndarray | None = None  # the edges of the cage


def _is_of_follower(attribute: bpy.types.Attribute) -> bool:
    """Tells whether the attribute has the name of one that stores places on another surface. The
    user's own of such a name would be in the way of those that the new mesh may get.
    """
    name = attribute.name
    return name in ROOT_KINDS or name in _OF_FOLLOWERS or name.startswith(ids.LIVE_REST)


def _is_users(attribute: bpy.types.Attribute) -> bool:
    """Tells whether such an attribute is certainly the user's own, because of its type."""
    wanted = root_attributes(attribute.id_data).get(attribute.name)
    return wanted is not None and (attribute.data_type, attribute.domain) != wanted


def read(mesh: bpy.types.Mesh, with_sharp_faces: bool) -> CageAttributes:
    """Reads the attributes from the mesh that the cage is read from."""
    found = CageAttributes(corner_edge=attributes.read(mesh, ids.CORNER_EDGE))
    uv_names = set(mesh.uv_layers.keys())
    for attribute in mesh.attributes:
        name, kind = attribute.name, attribute.data_type
        if name.startswith(".") and name != SEAM_BEFORE_5:
            continue
        if _is_of_follower(attribute):
            if _is_users(attribute):
                found.notes.append(
                    f"{name} is not carried over: the name is reserved for places on a surface"
                )
            continue
        if name in _OWN and not (name == "sharp_face" and with_sharp_faces):
            continue
        if kind not in attributes.LAYOUTS:
            found.notes.append(
                f"{name} is not carried over: attributes of type {kind.lower()} are not supported"
            )
            continue
        values = _read(attribute)
        if kind in LINEAR and attribute.domain in ("POINT", "CORNER"):
            if not np.isfinite(values).all():
                found.notes.append(f"{name} is not carried over: it has values that are not finite")
                continue
            if name in uv_names:
                found.uv_maps.append(uv_map.read(mesh, name))
                continue
        found.attributes.append(Attribute(name, kind, attribute.domain, values))
    return found


def write(mesh: bpy.types.Mesh, attribute: Attribute) -> None:
    """Writes the attributes to a mesh that does not have them yet."""
    made = mesh.attributes.get(attribute.name) or mesh.attributes.new(
        attribute.name, attribute.kind, attribute.domain
    )
    layout = attributes.LAYOUTS[attribute.kind]
    values: np.ndarray = np.ascontiguousarray(attribute.values, layout.dtype)
    made.data.foreach_set(_key(attribute.kind), values.ravel())


class Carrier:
    """Evaluates a cage's attributes on a tessellation of its limit surface."""

    def __init__(
        self, cage: CageAttributes, surface: limitsurf.LimitSurface, on: limitsurf.Tessellation
    ) -> None:
        self._cage, self._surface, self._on = cage, surface, on
        self._elements = CageElements(surface)
        self._corner_face = np.repeat(on.ptex_face, on.face_sizes)

    def attributes(
        self, uv_interpolation: rules.Interpolation, progress: Progress
    ) -> Iterator[Attribute]:
        """Evaluates all attributes but those of edges. UV maps come last, as FLOAT2 of CORNER."""
        steps = 3 + len(self._cage.uv_maps)
        yield from self._linear("POINT")
        progress(1 / steps)
        yield from self._linear("CORNER")
        progress(2 / steps)
        yield from self._copied()
        for i, found in enumerate(self._cage.uv_maps):
            data = self._surface.face_varying(found.values, found.indices, uv_interpolation)
            yield Attribute(found.name, "FLOAT2", "CORNER", self._at_corners(data))
            progress((3 + i) / steps)

    def on_edges(self, mesh: bpy.types.Mesh) -> Iterator[Attribute]:
        """Evaluates the attributes on the tessellation's edges, in the order in which the mesh
        numbers them.
        """
        some = [each for each in self._cage.attributes if each.domain == "EDGE"]
        if not some:
            return
        uv = self._on.corner_uv
        side = self._elements.corner_of_side(
            self._corner_face, uv, uv[ragged_rows.following(self._on.face_sizes)]
        )
        edge, on_cage = attributes.read(mesh, ids.CORNER_EDGE), side >= 0
        assert self._cage.corner_edge is not None
        from_edge = self._cage.corner_edge[side[on_cage]]
        for each in some:
            values = np.zeros((len(mesh.edges), *each.values.shape[1:]), each.values.dtype)
            values[edge[on_cage]] = each.values[from_edge]
            yield each._replace(values=values)

    def weights(self, weights: np.ndarray) -> np.ndarray:
        """Returns the weights (points, groups) for those of the cage's vertices (vertices,
        groups).
        """
        return self._at_points(self._surface.varying(weights))

    def _linear(self, domain: str) -> Iterator[Attribute]:
        some = [e for e in self._cage.attributes if e.domain == domain and e.kind in LINEAR]
        if not some:
            return
        columns = [each.values.reshape(len(each.values), -1).astype(np.float64) for each in some]
        together = np.concatenate(columns, axis=1)
        if domain == "POINT":
            values = self._at_points(self._surface.varying(together))
        else:
            own = np.arange(len(together))
            values = self._at_corners(self._surface.face_varying(together, own, "all"))
        ends = np.cumsum([column.shape[1] for column in columns])[:-1]
        for each, part in zip(some, np.split(values, ends, axis=1), strict=True):
            yield each._replace(values=part)

    def _copied(self) -> Iterator[Attribute]:
        on, elements = self._on, self._elements
        rows = {
            "FACE": lambda: on.base_face,
            "CORNER": lambda: elements.nearest_corner(self._corner_face, on.corner_uv),
            "POINT": lambda: self._surface.mesh.face_vertices[
                elements.nearest_corner(on.locations.face, on.locations.uv)
            ],
        }
        for domain, row in rows.items():
            linear = LINEAR if domain != "FACE" else ()
            some = [e for e in self._cage.attributes if e.domain == domain and e.kind not in linear]
            at = row() if some else None
            for each in some:
                yield each._replace(values=each.values[at])

    def _at_points(self, data: limitsurf.SurfaceData) -> np.ndarray:
        return _evaluated(data, self._on.locations.face, self._on.locations.uv)

    def _at_corners(self, data: limitsurf.SurfaceData) -> np.ndarray:
        return _evaluated(data, self._corner_face, self._on.corner_uv)


def _evaluated(data: limitsurf.SurfaceData, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
    result = np.empty((len(face), data.shape[1]), np.float32)
    for begin in range(0, len(face), _PART):
        rows = slice(begin, begin + _PART)
        result[rows] = data.evaluate(face[rows], uv[rows], dtype=np.float32).value
    return result


def _read(attribute: bpy.types.Attribute) -> np.ndarray:
    layout = attributes.LAYOUTS[attribute.data_type]
    values: np.ndarray = np.empty(len(attribute.data) * layout.width, layout.dtype)
    attribute.data.foreach_get(_key(attribute.data_type), values)
    return values if layout.width == 1 else values.reshape(-1, layout.width)


def _key(kind: str) -> str:
    """Returns the key of an attribute's type. Colours of 8 bits are interpolated in the form in
    which they are stored.
    """
    return "color_srgb" if kind == "BYTE_COLOR" else attributes.LAYOUTS[kind].key
