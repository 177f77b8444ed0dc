# SPDX-License-Identifier: GPL-3.0-or-later
"""The attributes that bind generated things to their places on the surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import ids
from ..reading import attributes
from . import roots
from .rotations import quaternions

if TYPE_CHECKING:
    import limitsurf


class Binding:
    """The data stored with each location, so that it can be evaluated again for any pose."""

    def __init__(self, locations: roots.Locations) -> None:
        self._locations = locations
        self.root = np.empty((len(locations), 3), np.float32)
        self.rotation = np.empty((len(locations), 4), np.float32)

    def fill(self, part: roots.Roots) -> None:
        self.root[part.rows] = part.position
        self.rotation[part.rows] = quaternions(part.frame)

    def put_roots_on(self, surface: limitsurf.LimitSurface) -> None:
        """Replaces the roots by those on the limit surface."""
        face, uv = self._locations.face, self._locations.uv.astype(np.float64)
        self.root[:] = surface.evaluate(face, uv).position

    def write(self, data: bpy.types.ID, domain: str) -> None:
        attributes.write(data, ids.FACE, "INT", domain, self._locations.face)
        attributes.write(data, ids.UV, "FLOAT2", domain, self._locations.uv)
        attributes.write(data, ids.REST_ROOT, "FLOAT_VECTOR", domain, self.root)
        attributes.write(data, ids.REST_ROTATION, "QUATERNION", domain, self.rotation)
