# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature at the limit positions of the control mesh's vertices, stored there."""

import bpy
import numpy as np

from ..errors import RefusalError
from ..placing import new_objects
from ..reading import cage
from ..tasks.job import Progress
from . import storage
from .settings import Settings
from .values import CurvedSurface, Values


class ControlMesh:
    noun = "vertices"
    notes: tuple[str, ...] = ()

    def __init__(self, context: bpy.types.Context, settings: Settings) -> None:
        ob = context.active_object
        self._found = cage.read(ob, context.evaluated_depsgraph_get())
        self._key = new_objects.key(ob)
        self._settings = settings
        self._check(ob)

    def measure(self, progress: Progress) -> list[Values]:
        on = CurvedSurface(self._found, self._settings.in_world, self._settings.radius)
        at = on.surface.vertex_locations()
        return [on.values(at.face, at.uv, self._found.matrix, progress)]

    def store(
        self, _context: bpy.types.Context, values: list[Values], colors: list[np.ndarray]
    ) -> str:
        ob = new_objects.find(self._key)
        self._check(ob)
        storage.write_on_mesh(ob.data, values[0], colors[0])
        return ob.name

    def _check(self, ob: bpy.types.Object) -> None:
        reason = cage.why_not_on_mesh(ob, self._found)
        if reason:
            raise RefusalError(f"Curvature cannot be stored on the control mesh: {reason}")
        storage.check(ob, "POINT")
