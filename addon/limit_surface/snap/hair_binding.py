# SPDX-License-Identifier: GPL-3.0-or-later
"""The binding that snapped hair stores: the same as that of new hair."""

import bpy
import numpy as np

from .. import ids, native
from ..errors import RefusalError
from ..placing import live_attributes
from ..placing.posed_surface import Places
from ..placing.present_shape import PresentShape
from ..reading import attributes
from .surface import TargetSurface

_KINDS = {
    ids.FACE: "INT",
    ids.UV: "FLOAT2",
    ids.REST_ROOT: "FLOAT_VECTOR",
    ids.REST_ROTATION: "QUATERNION",
    ids.SURFACE_UV: "FLOAT2",
}
NOWHERE = -1  # the face of strands that are not bound to a surface


class HairBinding:
    """The binding of some strands. `is_whole` means that all strands of the hair are snapped, so
    that the hair can change to another surface.
    """

    def __init__(self, shape: PresentShape, surface: TargetSurface, is_whole: bool) -> None:
        data = shape.data
        self._shape = shape
        self._surface, self._is_whole = surface, is_whole
        for name, kind in _KINDS.items():
            attribute = data.attributes.get(name)
            if attribute and (attribute.data_type, attribute.domain) != (kind, "CURVE"):
                raise RefusalError(
                    f"{data.name}: the attribute {name} exists with another type or domain: "
                    "rename or remove it"
                )
        if not is_whole and data.surface not in (None, surface.ob):
            raise RefusalError(
                f"{data.name} is hair of {data.surface.name}: select all its strands to move it to "
                f"{surface.ob.name}"
            )

    @property
    def _data(self) -> bpy.types.Curves:
        return self._shape.data

    @property
    def target(self) -> bpy.types.Object:
        return self._surface.ob

    def places(self, face: np.ndarray, uv: np.ndarray, space: np.ndarray) -> Places:
        return self._surface.places(face, uv, space)

    def rest_frames(self, curves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns which of the curves are bound to a surface already, and their frames (m, 3, 3)
        there: at rest, or of hair that follows, as it is now.
        """
        if not {ids.FACE, ids.REST_ROTATION} <= set(self._data.attributes.keys()):
            return np.zeros(len(curves), bool), np.tile(np.eye(3), (len(curves), 1, 1))
        rotation = self._shape.read(ids.REST_ROTATION)[curves].astype(np.float64)
        bound = self._shape.read(ids.FACE)[curves] != NOWHERE
        return bound, native.limitsurf.rotation_matrices(rotation)

    def write(
        self,
        curves: np.ndarray,
        face: np.ndarray,
        uv: np.ndarray,
        space: np.ndarray,
        follows: bool,
    ) -> list[str]:
        """Writes the binding, and returns remarks for the report. What follows the surface follows
        the limit surface, so that its distance from it is kept where it stands on displayed
        polygons.
        """
        places = self._surface.places(face, uv, space, on_limit=follows)
        self._store(ids.FACE, NOWHERE, curves, face)
        self._store(ids.UV, 0, curves, uv)
        self._store(ids.REST_ROOT, 0, curves, places.position)
        self._store(
            ids.REST_ROTATION, (1, 0, 0, 0), curves, native.limitsurf.quaternions(places.frame)
        )
        live_attributes.begin_anew(self._data, curves)
        self._data.surface = self._surface.ob
        without = self._why_no_uvs()
        if without:
            return [f"UVs were not stored: {without}"]
        self._data.surface_uv_map = self._surface.cage.chosen_uv_map.name
        surface_uv = self._surface.surface_uv(face, uv)
        assert surface_uv is not None
        self._store(ids.SURFACE_UV, 0, curves, surface_uv)
        return []

    def _why_no_uvs(self) -> str:
        found = self._surface.cage.uv_map
        if found is None:
            return self._surface.cage.without_uv_map or f"{self._surface.ob.name} has no UV map"
        used = self._data.surface_uv_map
        if not self._is_whole and used not in ("", found.name):
            return f"the other strands use the UV map {used}, but {found.name} is active"
        return ""

    def _store(
        self, name: str, nothing: float | tuple[float, ...], curves: np.ndarray, values: np.ndarray
    ) -> None:
        kind = _KINDS[name]
        if name in self._data.attributes:
            stored = attributes.read(self._data, name)
        else:
            stored = np.empty((len(self._data.curves), *np.shape(values)[1:]))
            stored[:] = nothing
        stored[curves] = values
        attributes.write(self._data, name, kind, "CURVE", stored)
