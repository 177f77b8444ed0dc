# SPDX-License-Identifier: GPL-3.0-or-later
"""The attributes that bind generated things to their places on the surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import ids, native
from ..reading import attributes
from ..tasks.job import Progress
from . import roots, seals
from .posed_surface import PosedSurface

if TYPE_CHECKING:
    import limitsurf


class Binding:
    """The data stored with each location, so that it can be evaluated again for any pose."""

    def __init__(self, locations: roots.Locations) -> None:
        self.locations = locations
        self.root = np.empty((len(locations), 3), np.float32)
        self.rotation = np.empty((len(locations), 4), np.float32)

    @classmethod
    def at(cls, posed: PosedSurface, locations: roots.Locations, space: np.ndarray) -> Binding:
        """Returns the binding of things whose object has the matrix `space`."""
        binding = cls(locations)
        places = posed.places(locations.face, locations.uv.astype(np.float64), space)
        binding.root[:] = places.position
        binding.rotation[:] = native.limitsurf.quaternions(places.frame)
        return binding

    @classmethod
    def on(
        cls, surface: limitsurf.LimitSurface, locations: roots.Locations, progress: Progress
    ) -> Binding:
        """Returns the binding of things that stand on the surface itself, in its space."""
        binding = cls(locations)
        for part in roots.evaluate(roots.on_surface(surface), locations, progress):
            binding.fill(part)
        return binding

    def fill(self, part: roots.Roots) -> None:
        self.root[part.rows] = part.position
        self.rotation[part.rows] = native.limitsurf.quaternions(part.frame)

    def put_roots_on(self, surface: limitsurf.LimitSurface) -> None:
        """Replaces the roots by those on the limit surface."""
        face, uv = self.locations.face, self.locations.uv.astype(np.float64)
        self.root[:] = surface.evaluate(face, uv).position

    def write(self, data: bpy.types.ID, domain: str) -> None:
        attributes.write(data, ids.FACE, "INT", domain, self.locations.face)
        attributes.write(data, ids.UV, "FLOAT2", domain, self.locations.uv)
        attributes.write(data, ids.REST_ROOT, "FLOAT_VECTOR", domain, self.root)
        attributes.write(data, ids.REST_ROTATION, "QUATERNION", domain, self.rotation)
        seals.seal(data, np.arange(len(self.locations)))
