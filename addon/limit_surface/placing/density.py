# SPDX-License-Identifier: GPL-3.0-or-later
"""Densities over a surface, from vertex groups, images and attributes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..errors import RefusalError
from ..sources.source_mesh import SourceMesh
from ..sources.values import ValueChoice, ValueMap

if TYPE_CHECKING:
    import limitsurf

#: A function from Ptex faces (n,) and uv (n, 2) to densities (n,), all at least 0
Density = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class DensityMap:
    """Numbers that are densities where they are above 0."""

    values: ValueMap

    def on(self, surface: limitsurf.LimitSurface) -> Density:
        values = self.values.on(surface)
        return lambda face, uv: np.maximum(values(face, uv), 0)


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
