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
        curves.add_curves(strands.sizes.tolist())
        attributes.write(curves, ids.POSITION, "FLOAT_VECTOR", "POINT", strands.position)
        attributes.write(curves, "radius", "FLOAT", "POINT", strands.radius)
        strands.binding.write(curves, "CURVE")
        curves.surface = surface
        for material in materials:
            curves.materials.append(material)
        if strands.surface_uv is not None:
            curves.surface_uv_map = strands.uv_map
            attributes.write(curves, ids.SURFACE_UV, "FLOAT2", "CURVE", strands.surface_uv)
        return add_on_surface(context, name, curves, surface)
    except BaseException:
        bpy.data.hair_curves.remove(curves)
        raise
