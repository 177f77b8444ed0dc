# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice of the faces that are covered, by material slots and by selection."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import attributes


@dataclass(frozen=True)
class MaskChoice:
    material_slots: frozenset[int]  # covers faces of all slots if empty
    faces: str  # ALL, SELECTED or ATTRIBUTE
    attribute: str

    def uncovered(self, mesh: bpy.types.Mesh, whose: str) -> np.ndarray:
        """Returns the faces of a cage's mesh that are not covered. Raises RefusalError if this is
        all of them.
        """
        bare = np.zeros(len(mesh.polygons), bool)
        if self.material_slots:
            bare |= ~np.isin(_material_slots(mesh), list(self.material_slots))
            if bare.all():
                slots = ", ".join(str(slot) for slot in sorted(self.material_slots))
                raise RefusalError(f"{whose}: no face has a material of the slots {slots}")
        if self.faces != "ALL":
            bare |= ~(_selected(mesh) if self.faces == "SELECTED" else self._attribute(mesh, whose))
            if bare.all():
                raise RefusalError(f"{whose}: none of the faces is {self._called()}")
        return np.flatnonzero(bare)

    def _attribute(self, mesh: bpy.types.Mesh, whose: str) -> np.ndarray:
        if not self.attribute:
            raise RefusalError(f"Choose an attribute that says which faces of {whose} are used")
        found = mesh.attributes.get(self.attribute)
        if found is None:
            raise RefusalError(f"{whose} has no attribute {self.attribute!r} to choose faces by")
        if (found.data_type, found.domain) != ("BOOLEAN", "FACE"):
            raise RefusalError(
                f"{whose}: the attribute {self.attribute} cannot choose faces: it is "
                f"{found.data_type} on {found.domain}, not BOOLEAN on FACE"
            )
        return attributes.read(mesh, self.attribute)

    def _called(self) -> str:
        return "selected" if self.faces == "SELECTED" else f"true in {self.attribute}"


def _selected(mesh: bpy.types.Mesh) -> np.ndarray:
    values = np.empty(len(mesh.polygons), bool)
    mesh.polygons.foreach_get("select", values)
    return values


def _material_slots(mesh: bpy.types.Mesh) -> np.ndarray:
    """Returns the slot of each face. A number beyond the last slot means the last one, as in
    renders.
    """
    values = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", values)
    return values.clip(0, max(len(mesh.materials) - 1, 0))
