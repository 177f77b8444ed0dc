# SPDX-License-Identifier: GPL-3.0-or-later
"""Densities over a surface, from vertex groups, images and attributes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..errors import RefusalError
from ..sources.source_mesh import SourceMesh
from ..sources.values import ValueChoice, ValueMap, Values

if TYPE_CHECKING:
    import limitsurf


@dataclass(frozen=True)
class Density:
    values: Values

    def __call__(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Returns the densities (n,), all at least 0, at Ptex faces (n,) and uv (n, 2)."""
        return np.maximum(self.values(face, uv), 0)

    @cached_property
    def limits(self) -> np.ndarray:
        """Numbers that the density does not exceed on n x n equal squares of each Ptex face,
        (f, n, n); NaN where there is no surface.
        """
        return np.maximum(self.values.upper_bounds(), 0)


@dataclass(frozen=True)
class DensityMap:
    """Numbers that are densities where they are above 0."""

    values: ValueMap

    def on(self, surface: limitsurf.LimitSurface) -> Density:
        return Density(self.values.on(surface))


@dataclass(frozen=True)
class DensityChoice:
    values: ValueChoice

    @property
    def image(self) -> str:
        return self.values.image

    def wanted_vertex_groups(self, ob: bpy.types.Object) -> list[str]:
        return self.values.wanted_vertex_groups(ob)

    def read(self, mesh: SourceMesh) -> DensityMap | None:
        """Reads the density from the cage's mesh. Raises RefusalError where the source does not
        exist, or is 0 everywhere.
        """
        found = self.values.read(mesh)
        if found is None:
            return None
        is_clipped = found.image is not None and found.image.extension == "CLIP"
        if found.largest <= 0 and not is_clipped:  # outside of such an image it may be more
            raise RefusalError("The density is 0 everywhere: check its source and its range")
        return DensityMap(found)
