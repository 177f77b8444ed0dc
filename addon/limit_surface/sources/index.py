# SPDX-License-Identifier: GPL-3.0-or-later
"""Members of a collection over a surface, from vertex groups, images and attributes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from .source_mesh import SourceMesh
from .values import ValueChoice, ValueMap

if TYPE_CHECKING:
    import limitsurf

_WHOLE = {"INT", "INT8"}

#: A function from Ptex faces (n,), uv (n, 2) and the number of members to their numbers (n,)
Members = Callable[[np.ndarray, np.ndarray, int], np.ndarray]


@dataclass(frozen=True)
class IndexMap:
    """Values from 0 for the first member to 1 for the last one, or the members' numbers themselves,
    which begin again after the last one. Between vertices the number of the nearest corner counts.
    """

    values: ValueMap
    are_numbers: bool

    def on(self, surface: limitsurf.LimitSurface) -> Members:
        values = self.values.on(surface)
        is_quad = surface.mesh.face_sizes[surface.base_face] == 4

        def at(face: np.ndarray, uv: np.ndarray, count: int) -> np.ndarray:
            if not self.are_numbers:
                return np.floor(values(face, uv) * count).clip(0, count - 1).astype(np.int32)
            # a sub-face of a face with another number of corners belongs to the corner at (0, 0)
            corner = np.round(uv) * is_quad[face][:, None]
            return np.rint(values(face, corner)).astype(np.int64) % count

        return at


class IndexChoice(ValueChoice):
    """The choice of a source of members. Attributes with whole numbers hold the members' numbers;
    the range counts for all other sources.
    """

    @classmethod
    def of(cls, choice: ValueChoice) -> IndexChoice:
        return cls(**{field.name: getattr(choice, field.name) for field in fields(choice)})

    def read(self, mesh: SourceMesh) -> IndexMap | None:  # type: ignore[override]
        found = super().read(mesh)
        if found is None:
            return None
        if self.source == "ATTRIBUTE" and mesh.find_attribute(self.attribute).data_type in _WHOLE:
            whole = ValueMap(found.values, found.indices, found.interpolation, None, 0.0, 1.0)
            return IndexMap(whole, are_numbers=True)
        return IndexMap(found, are_numbers=False)
