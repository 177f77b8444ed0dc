# SPDX-License-Identifier: GPL-3.0-or-later
"""The locations of strands and points on a surface, as data-blocks store them."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..reading import attributes
from .roots import Locations

NOWHERE = -1  # the face of elements that have no place on the surface
#: The attributes of each strand or point
ROOT_KINDS = {
    ids.FACE: "INT",
    ids.UV: "FLOAT2",
    ids.REST_ROOT: "FLOAT_VECTOR",
    ids.REST_ROTATION: "QUATERNION",
}


@dataclass(frozen=True)
class Places:
    """The locations of the elements that have one. Curves that were added later have no rotation
    at rest, and snapped hair that is bound nowhere has the face NOWHERE.
    """

    count: int
    rows: np.ndarray  # (n,) the elements that have a location
    face: np.ndarray  # (n,)
    uv: np.ndarray  # (n, 2)

    @classmethod
    def read(cls, data: bpy.types.ID) -> Places:
        face = attributes.read(data, ids.FACE)
        turned = attributes.read(data, ids.REST_ROTATION).any(axis=1)
        rows = np.flatnonzero((face >= 0) & turned)
        uv = attributes.read(data, ids.UV)[rows].astype(np.float64)
        return cls(len(face), rows, face[rows], uv)

    @classmethod
    def of(cls, new: Locations) -> Places:
        rows = np.arange(len(new))
        return cls(len(new), rows, new.face, new.uv.astype(np.float64))

    @property
    def resting(self) -> int:
        return self.count - len(self.rows)

    def check(self, faces: int, surface: str) -> None:
        """Raises RefusalError where a face does not exist."""
        wrong = self.face[self.face >= faces]
        if len(wrong):
            raise RefusalError(
                f"A location is on face {wrong[0]}, but {surface} has {faces} faces: its topology "
                "has changed since things were placed on it"
            )

    def check_count(self, data: bpy.types.ID) -> None:
        stored = len(data.attributes[ids.FACE].data)
        if stored != self.count:
            raise RefusalError(
                f"{data.name} has changed meanwhile: it has {stored} elements instead of "
                f"{self.count}"
            )

    def write(self, data: bpy.types.ID, tile: np.ndarray, tile_uv: np.ndarray) -> None:
        numbers, place = np.zeros(self.count, np.int32), np.zeros((self.count, 2))
        numbers[self.rows], place[self.rows] = tile + 1, tile_uv
        domain = data.attributes[ids.FACE].domain
        attributes.write(data, ids.TILE, "INT", domain, numbers)
        attributes.write(data, ids.TILE_UV, "FLOAT2", domain, place)
        data.update_tag()
