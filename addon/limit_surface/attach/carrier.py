# SPDX-License-Identifier: GPL-3.0-or-later
"""The carrier of a surface: a hidden object that follows it, with three vertices for each object
that is attached. Blender's own parenting to three vertices does the rest.

It stands in the world's space, so that a stretched surface turns and moves the attached objects but
does not shear them.
"""

from __future__ import annotations

import bpy
import numpy as np

from .. import ids
from ..placing import following, tables
from ..placing.binding import Binding
from ..placing.followers import own_followers_of
from ..placing.posed_surface import Places
from ..reading import attributes

CORNERS = 3
# The vertices of one object, as shares of the carrier's size along the frame's axes
_TRIANGLE = np.array([[1, 0, 0], [-(1 / 2), (3 / 4) ** 0.5, 0], [-(1 / 2), -((3 / 4) ** 0.5), 0]])


def is_carrier(ob: bpy.types.Object | None) -> bool:
    return ob is not None and ids.CARRIER_MARK in ob


def carrier_of(surface: bpy.types.Object) -> bpy.types.Object | None:
    return next((ob for ob in own_followers_of(surface) if is_carrier(ob)), None)


class Extension:
    """New vertices of a surface's carrier, which is made if there is none. Where no object uses
    vertices any more, they are used again.
    """

    def __init__(
        self,
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        binding: Binding,
        places: Places,
        size: float,
    ) -> None:
        """Adds vertices at places in the world. Triangles of about the size of the surface keep the
        most digits. Raises RefusalError where the surface cannot be followed; nothing has changed
        then.
        """
        following.Request(surface, depsgraph)
        there = carrier_of(surface)
        self.carrier = tables.hidden_object(ids.CARRIER, surface, there)
        before = self.carrier.data
        try:
            self.vertices = self._extend(binding, places, size)
            self.carrier[ids.CARRIER_MARK] = True
            request = following.Request(surface, depsgraph, [self.carrier])
            request.compute().write()
        except BaseException:
            added, self.carrier.data = self.carrier.data, before
            if added != before:
                bpy.data.meshes.remove(added)
            if there is None:
                tables.remove_object(self.carrier)
            raise
        if before != self.carrier.data and not before.users:
            bpy.data.meshes.remove(before)

    def _extend(self, binding: Binding, places: Places, size: float) -> np.ndarray:
        """Gives the carrier a mesh with more vertices, and returns those of each object (n, 3)."""
        old = self.carrier.data
        count = len(places.position)
        mesh = self.carrier.data = old.copy()
        had = len(mesh.vertices) // CORNERS
        free = np.setdiff1d(np.arange(had), _used(self.carrier))[:count]
        objects = np.concatenate([free, had + np.arange(count - len(free))])
        vertices = CORNERS * objects[:, None] + np.arange(CORNERS)
        mesh.vertices.add(CORNERS * (count - len(free)))
        triangles = np.einsum("nij,kj->nki", places.frame, size * _TRIANGLE)
        for name, kind, values in (
            (ids.POSITION, "FLOAT_VECTOR", places.position[:, None] + triangles),
            (ids.FACE, "INT", binding.locations.face[:, None]),
            (ids.UV, "FLOAT2", binding.locations.uv[:, None]),
            (ids.REST_ROOT, "FLOAT_VECTOR", binding.root[:, None]),
            (ids.REST_ROTATION, "QUATERNION", binding.rotation[:, None]),
        ):
            _put(mesh, name, kind, vertices, values)
        return vertices


def _put(
    mesh: bpy.types.Mesh, name: str, kind: str, vertices: np.ndarray, values: np.ndarray
) -> None:
    if name not in mesh.attributes:
        attributes.add(mesh, name, kind, "POINT")
    stored = attributes.read(mesh, name)
    stored[vertices] = values
    attributes.write(mesh, name, kind, "POINT", stored)


def _used(carrier: bpy.types.Object) -> list[int]:
    """Returns the numbers of the objects' triangles that are in use."""
    return [
        ob.parent_vertices[0] // CORNERS
        for ob in bpy.data.objects
        if ob.parent == carrier and ob.parent_type == "VERTEX_3"
    ]
