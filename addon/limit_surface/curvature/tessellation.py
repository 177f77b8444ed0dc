# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature on a new mesh whose vertices lie on the limit surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import ids
from ..placing import new_objects
from ..reading import cage
from ..reading.subdivided_mesh import polygon_counts
from ..tasks.job import Progress, part_of
from ..tasks.object_keys import ObjectKey
from ..tasks.request_size import RequestSize
from . import storage
from .settings import Settings
from .values import CurvedSurface, Values

if TYPE_CHECKING:
    import limitsurf

_TESSELLATED = 0.3  # the part of the progress that the tessellation takes


class Tessellation:
    noun = "vertices"
    notes: tuple[str, ...] = ()

    def __init__(self, context: bpy.types.Context, settings: Settings) -> None:
        ob = context.active_object
        self._found = cage.read(ob, context.evaluated_depsgraph_get())
        self._key = ObjectKey.of(ob)
        self._settings = settings
        count = int(polygon_counts(self._found.face_sizes, settings.levels).sum())
        RequestSize("polygons", count, 1, is_exact=False).check(settings.allow_large)
        self._mesh: limitsurf.Tessellation | None = None

    def relied_on(self) -> list[tuple[bpy.types.Object, tuple[str, ...]]]:
        """Returns the objects that were read, with the names of those of their attributes."""
        return [(self._key.find(), ())]

    def measure(self, progress: Progress) -> list[Values]:
        found, settings = self._found, self._settings
        local = CurvedSurface(found, False, settings.radius)
        self._mesh = local.surface.tessellate(
            settings.levels, progress=part_of(progress, 0, _TESSELLATED)
        )
        on = CurvedSurface(found, True, settings.radius) if settings.in_world else local
        at = self._mesh.locations
        values = on.values(at.face, at.uv, found.matrix, part_of(progress, _TESSELLATED, 1))
        return [values]

    def store(
        self, context: bpy.types.Context, values: list[Values], colors: list[np.ndarray]
    ) -> str:
        surface = self._key.find()
        mesh = bpy.data.meshes.new(ids.CURVATURE_OBJECT)
        try:
            self._fill(mesh)
            storage.write_on_mesh(mesh, values[0], colors[0])
            ob = new_objects.add_on_surface(context, ids.CURVATURE_OBJECT, mesh, surface)
        except BaseException:
            bpy.data.meshes.remove(mesh)
            raise
        context.view_layer.update()
        return ob.name

    def _fill(self, mesh: bpy.types.Mesh) -> None:
        made = self._mesh
        assert made is not None
        sizes = np.full(len(made.faces), 4)
        new_objects.add_polygons(mesh, made.positions, sizes, made.faces.ravel())
        mesh.normals_split_custom_set_from_vertices(made.normals.astype(np.float32))
