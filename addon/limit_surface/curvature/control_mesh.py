# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature at the limit positions of the control mesh's vertices, stored there."""

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import cage
from ..tasks.job import Progress
from ..tasks.object_keys import ObjectKey
from . import storage
from .settings import Settings
from .values import CurvedSurface, Values


class ControlMesh:
    noun = "vertices"
    notes: tuple[str, ...] = ()

    def __init__(self, context: bpy.types.Context, settings: Settings) -> None:
        ob = context.active_object
        self._found = cage.read(ob, context.evaluated_depsgraph_get())
        self._key = ObjectKey.of(ob)
        self._settings = settings
        self._check(ob)

    def relied_on(self) -> list[tuple[bpy.types.Object, tuple[str, ...]]]:
        """Returns the objects that were read, with the names of those of their attributes."""
        return [(self._key.find(), ())]

    def measure(self, progress: Progress) -> list[Values]:
        on = CurvedSurface(self._found, self._settings.in_world, self._settings.radius)
        at = on.surface.vertex_locations()
        return [on.values(at.face, at.uv, self._found.matrix, progress)]

    def store(
        self, _context: bpy.types.Context, values: list[Values], colors: list[np.ndarray]
    ) -> str:
        ob = self._key.find()
        self._check(ob)
        storage.write_on_mesh(ob.data, values[0], colors[0])
        return ob.name

    def _check(self, ob: bpy.types.Object) -> None:
        reason = cage.why_not_on_mesh(ob, self._found)
        if reason:
            raise RefusalError(f"Curvature cannot be stored on the control mesh: {reason}")
        storage.check(ob, "POINT")
