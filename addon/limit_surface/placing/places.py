# SPDX-License-Identifier: GPL-3.0-or-later
"""The locations of strands and points on a surface, as data-blocks store them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..counting import counted
from ..errors import RefusalError
from ..reading import attributes
from . import seals
from .roots import Locations

NOWHERE = -1  # the face of elements that have no place on the surface
_UNTURNED = (1, 0, 0, 0)  # the default rotation
#: The attributes of each strand or point
ROOT_KINDS = {
    ids.FACE: "INT",
    ids.UV: "FLOAT2",
    ids.REST_ROOT: "FLOAT_VECTOR",
    ids.REST_ROTATION: "QUATERNION",
}


def domain_of(data: bpy.types.ID) -> str:
    """Returns the domain on which locations are stored in data of this type."""
    return "CURVE" if isinstance(data, bpy.types.Curves) else "POINT"


def without_frame(rotation: np.ndarray) -> np.ndarray:
    """Tells which rotations at rest (n, 4) are none."""
    return ~rotation.any(axis=1)


def root_attributes(data: bpy.types.ID) -> dict[str, tuple[str, str]]:
    """Returns the type and the domain of each attribute of locations in data of this type."""
    return {name: (kind, domain_of(data)) for name, kind in ROOT_KINDS.items()}


def lacking(data: bpy.types.ID, needed: Mapping[str, tuple[str, str]]) -> str:
    """Returns the name of the first of these attributes that does not exist, or is of another type
    or domain than these; nothing where all are there.
    """
    for name, wanted in needed.items():
        stored = data.attributes.get(name)
        if stored is None or (stored.data_type, stored.domain) != wanted:
            return name
    return ""


def check_uv(uv: np.ndarray, called: str) -> None:
    """Raises RefusalError for u and v (n, 2) that are not between 0 and 1, or are no numbers."""
    if not (uv.min(initial=0) >= 0 and uv.max(initial=0) <= 1):
        u, v = uv[(~((uv >= 0) & (uv <= 1))).any(axis=1).argmax()]
        raise RefusalError(
            f"{called} has u = {u:g} and v = {v:g}, which must be 0 to 1: the attribute {ids.UV} "
            "was changed"
        )


@dataclass(frozen=True)
class Places:
    """The locations of the elements that have one. All attributes of curves that were added later
    have Blender's default values, and snapped hair that is bound nowhere has the face NOWHERE.
    Before version 0.2.0, strands that were joined to hair that followed live lost their rest
    orientation: without it a strand has no place. Nor have vertices whose seals are broken.
    """

    count: int
    rows: np.ndarray  # (n,) the elements that have a location
    face: np.ndarray  # (n,)
    uv: np.ndarray  # (n, 2)

    @classmethod
    def read(cls, data: bpy.types.ID) -> Places:
        """Raises RefusalError where an attribute is missing, or holds something else."""
        if name := lacking(data, root_attributes(data)):
            raise RefusalError(
                f"{data.name} stores no places on a limit surface: its attribute {name} is "
                "missing, or of another type or domain"
            )
        stored = {name: attributes.read(data, name) for name in ROOT_KINDS}
        broken = seals.are_broken(data)
        if broken is not None:
            stored[ids.FACE][broken] = NOWHERE
        return cls.among(stored)

    @classmethod
    def among(cls, stored: Mapping[str, np.ndarray]) -> Places:
        """Returns those of elements for which these attributes are stored."""
        face, uv = stored[ids.FACE], stored[ids.UV]
        has_place = (face >= 0) & ~without_frame(stored[ids.REST_ROTATION])
        # the default values mean face 0, where few elements are: only these are looked at
        first = np.flatnonzero(face == 0)
        rotation = stored[ids.REST_ROTATION][first]
        is_default = (
            ~uv[first].any(axis=1)
            & ~stored[ids.REST_ROOT][first].any(axis=1)
            & (rotation == _UNTURNED).all(axis=1)
        )
        has_place[first[is_default]] = False
        rows = np.flatnonzero(has_place)
        return cls(len(face), rows, face[rows], uv[rows].astype(np.float64))

    @classmethod
    def of(cls, new: Locations) -> Places:
        rows = np.arange(len(new))
        return cls(len(new), rows, new.face, new.uv.astype(np.float64))

    def without(self, rows: np.ndarray) -> Places:
        """Returns the places of all other elements."""
        others = ~np.isin(self.rows, rows)
        return Places(self.count, self.rows[others], self.face[others], self.uv[others])

    @property
    def resting(self) -> int:
        return self.count - len(self.rows)

    def check(self, faces: int, surface: str) -> None:
        """Raises RefusalError for locations that do not exist."""
        wrong = self.face[self.face >= faces]
        if len(wrong):
            raise RefusalError(
                f"A place is on face {wrong[0]}, but {surface} has "
                f"{counted(faces, 'faces')}: its topology has changed since things were placed on "
                "it"
            )
        check_uv(self.uv, f"A place on {surface}")

    def check_count(self, data: bpy.types.ID) -> None:
        stored = len(data.attributes[ids.FACE].data)
        if stored != self.count:
            raise RefusalError(
                f"{data.name} has changed meanwhile (it has {counted(stored, 'elements')} "
                f"instead of {self.count}): run the operator again"
            )

    def write(self, data: bpy.types.ID, tile: np.ndarray, tile_uv: np.ndarray) -> None:
        numbers, place = np.zeros(self.count, np.int32), np.zeros((self.count, 2))
        numbers[self.rows], place[self.rows] = tile + 1, tile_uv
        domain = data.attributes[ids.FACE].domain
        seals.seal(data, self.rows)
        attributes.write(data, ids.TILE, "INT", domain, numbers)
        attributes.write(data, ids.TILE_UV, "FLOAT2", domain, place)
        data.update_tag()
