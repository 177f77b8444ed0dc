# SPDX-License-Identifier: GPL-3.0-or-later
"""Where roots are on a surface that has changed: at the closest points, by their UVs, or by their
faces.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..reading import attributes, uv_map
from ..tasks.piecewise_job import Pieces, aside
from .places import NOWHERE
from .posed_surface import PosedSurface
from .relocation import Elements

if TYPE_CHECKING:
    import limitsurf


class Found(NamedTuple):
    """Where roots are on the surface as it is now; the face is NOWHERE where they are not."""

    face: np.ndarray  # (n,)
    uv: np.ndarray  # (n, 2)


class Finder:
    """Finds the new locations of elements. `keeps_frame` means that the faces are those of before,
    so that what is stored about the places at rest holds.
    """

    reason = ""
    keeps_frame = False

    def __call__(self, elements: Elements, rows: np.ndarray) -> Pieces:
        """Returns what was found (Found)."""
        raise NotImplementedError


class UvMaps:
    """The surface's UV maps, on which hair on a surface stores where it stands."""

    def __init__(
        self, posed: PosedSurface, mesh: bpy.types.Mesh, surface: bpy.types.Object
    ) -> None:
        self._posed, self._mesh, self._surface = posed, mesh, surface
        self._read: dict[bpy.types.ID, limitsurf.SurfaceData | RefusalError] = {}
        self.names: set[str] = set()  # of the maps that have been read

    def read(self, data: bpy.types.ID) -> None:
        """Reads the map that the hair names, or else the active one, as long as the mesh is
        there.
        """
        try:
            self._read[data] = self._of(data)
        except RefusalError as error:
            self._read[data] = error

    def of(self, data: bpy.types.ID) -> limitsurf.SurfaceData:
        """Returns that map. Raises RefusalError where there is none."""
        found = self._read[data]
        if isinstance(found, RefusalError):
            raise found
        return found

    def _of(self, data: bpy.types.ID) -> limitsurf.SurfaceData:
        active = self._surface.data.uv_layers.active
        name = getattr(data, "surface_uv_map", "") or (active.name if active else "")
        if not name:
            raise RefusalError(
                f"{self._surface.name} has no UV map, which the method UV needs. Choose another "
                "method, or add a UV map"
            )
        obstacle = uv_map.obstacle(self._mesh, name)
        if obstacle:
            raise RefusalError(f"{self._surface.name}: {obstacle}")
        self.names.add(name)
        found = uv_map.read(self._mesh, name)
        return self._posed.in_object.face_varying(
            found.values, found.indices, self._posed.cage.shown_uv_interpolation
        )


class Closest(Finder):
    def __init__(self, posed: PosedSurface, maps: UvMaps, max_distance: float) -> None:
        self.posed, self.maps, self.max_distance = posed, maps, max_distance
        self.reason = f"the surface is farther than {max_distance:.4g} from them"

    def __call__(self, elements: Elements, rows: np.ndarray) -> Pieces:
        roots = elements.roots()[rows]
        lost = np.flatnonzero(~np.isfinite(roots).all(axis=1))
        if len(lost):
            raise RefusalError(
                f"{elements.called(rows[lost[0]])} has a coordinate that is not a finite number: "
                "delete it, or choose another method"
            )
        hits = yield from aside(
            lambda progress: self.posed.in_world.closest(
                roots, self.max_distance, progress=progress
            )
        )
        return Found(hits.face, hits.uv)


class ByUv(Finder):
    """Takes the UV that Blender stores with hair on a surface."""

    reason = "the UV map does not cover their UVs"

    def __init__(self, maps: UvMaps) -> None:
        self._maps = maps

    def __call__(self, elements: Elements, rows: np.ndarray) -> Pieces:
        if not stores_uv(elements):
            raise RefusalError(
                f"{elements.ob.name} does not store the UVs of its roots (the attribute "
                f"{ids.SURFACE_UV} is missing), which the method UV needs. Choose another method"
            )
        uv = attributes.read(elements.data, ids.SURFACE_UV)[rows].astype(np.float64)
        on_surface = self._maps.of(elements.data)
        known = np.isfinite(uv).all(axis=1)
        at = yield from aside(lambda progress: on_surface.locate(uv[known], progress=progress))
        face = np.full(len(uv), NOWHERE, at.face.dtype)
        face[known], uv[known] = at.face, at.uv
        return Found(face, uv)


class ByFace(Finder):
    reason = "their faces no longer exist or have no limit surface"
    keeps_frame = True

    def __init__(self, posed: PosedSurface) -> None:
        surface = posed.in_object
        self._exists = np.ones(surface.face_count, bool)
        self._exists[np.isin(surface.base_face, list(surface.refused))] = False

    def __call__(self, elements: Elements, rows: np.ndarray) -> Pieces:
        yield 0.0
        face = elements.read(ids.FACE)[rows]
        there = face < len(self._exists)
        there[there] = self._exists[face[there]]
        return Found(np.where(there, face, NOWHERE), elements.read(ids.UV)[rows])


def stores_uv(elements: Elements) -> bool:
    stored = elements.data.attributes.get(ids.SURFACE_UV)
    return bool(stored) and (stored.data_type, stored.domain) == ("FLOAT2", elements.domain)
