# SPDX-License-Identifier: GPL-3.0-or-later
"""New hair that stands on a surface."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..reading import attributes
from .binding import Binding
from .new_objects import add_on_surface


@dataclass(frozen=True)
class Strands:
    """Strands in the surface's own space, one after the other."""

    binding: Binding
    sizes: np.ndarray  # (n,) numbers of points
    position: np.ndarray  # (points of all strands, 3)
    radius: np.ndarray  # (points of all strands,)
    surface_uv: np.ndarray | None  # (n, 2)
    uv_map: str

    @classmethod
    def equal(
        cls,
        binding: Binding,
        position: np.ndarray,
        radius: np.ndarray,
        surface_uv: np.ndarray | None,
        uv_map: str,
    ) -> Strands:
        """Returns strands (n, points, 3) with the radii (n,)."""
        count, points = position.shape[:2]
        sizes = np.full(count, points, np.int32)
        radii = radius.repeat(points)
        return cls(binding, sizes, position.reshape(-1, 3), radii, surface_uv, uv_map)

    def fill(self, curves: bpy.types.Curves) -> None:
        """Adds the strands to curves that have none."""
        curves.add_curves(self.sizes.tolist())
        attributes.write(curves, ids.POSITION, "FLOAT_VECTOR", "POINT", self.position)
        attributes.write(curves, "radius", "FLOAT", "POINT", self.radius)
        self.binding.write(curves, "CURVE")
        if self.surface_uv is not None:
            curves.surface_uv_map = self.uv_map
            attributes.write(curves, ids.SURFACE_UV, "FLOAT2", "CURVE", self.surface_uv)


def add(
    context: bpy.types.Context,
    name: str,
    surface: bpy.types.Object,
    strands: Strands,
    materials: Iterable[bpy.types.Material | None] = (),
) -> bpy.types.Object:
    """Adds a Curves object that shares the surface's transform, as Blender's Empty Hair does."""
    curves = bpy.data.hair_curves.new(name)
    try:
        strands.fill(curves)
        curves.surface = surface
        for material in materials:
            curves.materials.append(material)
        return add_on_surface(context, name, curves, surface)
    except BaseException:
        bpy.data.hair_curves.remove(curves)
        raise
