# SPDX-License-Identifier: GPL-3.0-or-later
"""Material slots into which operators put the materials that they make."""

import bpy
import numpy as np

from ..errors import RefusalError


def check(ob: bpy.types.Object) -> None:
    """Raises RefusalError where `put` would change a linked mesh, because the file would not store
    that change.
    """
    if not (ob.data.is_editable or _takes_its_own(ob)):
        raise RefusalError(
            f"{ob.name} cannot be given a material: its mesh {ob.data.name} is linked from another "
            "file"
        )


def put(ob: bpy.types.Object, material: bpy.types.Material) -> None:
    """Puts the material into the active slot where that is empty, else into a new slot. Faces take
    the new slot only if there was none before.
    """
    if ob.active_material is None and ob.material_slots:
        ob.active_material = material
        return
    ob.data.materials.append(material)
    ob.active_material_index = len(ob.material_slots) - 1


def unseen(ob: bpy.types.Object, material: bpy.types.Material) -> str:
    """Returns a warning if no face of the object's mesh has the material."""
    slots, mesh = ob.material_slots, ob.data
    used = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", used)
    if any(slots[i].material == material for i in np.unique(used.clip(0, len(slots) - 1))):
        return ""
    return f"No face of {ob.name} has the material {material.name}: assign it to see the image"


def _takes_its_own(ob: bpy.types.Object) -> bool:
    if not (ob.is_editable and ob.material_slots and ob.active_material is None):
        return False
    return ob.material_slots[ob.active_material_index].link == "OBJECT"
