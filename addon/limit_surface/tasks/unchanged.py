# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether objects are still what something was computed for. While work runs aside, other windows,
scripts and add-ons may change them.
"""

from __future__ import annotations

import zlib
from collections.abc import Collection

import bmesh
import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import attributes, splines
from ..reading.edited_mesh import as_edited
from .object_keys import ObjectKey

AGAIN = "run the operator again"
#: What a report calls the layout of an object's data
_LAYOUTS = {
    "MESH": "The faces",
    "CURVES": "The strands",
    "POINTCLOUD": "The points",
    "CURVE": "The splines",
    "SURFACE": "The splines",
    "LATTICE": "The points",
    "ARMATURE": "The bones",
}


class Unchanged:
    """What an object is like now, as far as the work on it relies on that. Without `data` only
    whether it exists counts. Positions count only where the result would replace them (`shape`),
    and transforms only where it is computed in the world (`placed`). Of attributes, UV maps among
    them, those that are named count.
    """

    def __init__(
        self,
        ob: bpy.types.Object,
        *,
        data: bool = True,
        shape: bool = False,
        placed: bool = False,
        named: Collection[str] = (),
    ) -> None:
        self._key, self._of_data = ObjectKey.of(ob), data
        self._is_edited, self._data = _is_edited(ob), _number_of(ob.data)
        self._layout = _layout_of(ob) if data else None
        self._shape = _shape_of(ob) if shape else None
        self._matrix = ob.matrix_world.copy() if placed else None
        self._sums = {name: _sum_of(ob.data, name) for name in named}
        maps = ob.data.uv_layers.keys() if ob.type == "MESH" else ()
        self._uv_maps = set(named).intersection(maps)

    def check(self) -> None:
        """Raises RefusalError where that is not so any more."""
        ob = self._key.find()
        if self._matrix is not None and ob.matrix_world != self._matrix:
            raise RefusalError(f"{ob.name} was moved meanwhile: {AGAIN}")
        if self._of_data:
            self._check_data(ob)

    def _check_data(self, ob: bpy.types.Object) -> None:
        is_edited = _is_edited(ob)
        if is_edited and not self._is_edited:
            raise RefusalError(f"{ob.name} was put into Edit Mode meanwhile: leave it first")
        if self._is_edited and not is_edited:
            raise RefusalError(f"{ob.name} has left Edit Mode meanwhile: {AGAIN}")
        if _number_of(ob.data) != self._data:
            raise RefusalError(f"{ob.name} was given other data meanwhile: {AGAIN}")
        if _layout_of(ob) != self._layout:
            what = _LAYOUTS[ob.type]
            raise RefusalError(f"{what} of {ob.name} were changed meanwhile: {AGAIN}")
        if self._shape is not None and _shape_of(ob) != self._shape:
            raise RefusalError(f"Points of {ob.name} were moved meanwhile: {AGAIN}")
        for name, before in self._sums.items():
            if _sum_of(ob.data, name) != before:
                kind = "UV map" if name in self._uv_maps else "attribute"
                raise RefusalError(f"The {kind} {name} of {ob.name} was changed meanwhile: {AGAIN}")


def faces_of(mesh: bpy.types.Mesh) -> tuple[int, int, int]:
    """Returns what differs where the faces of a mesh in Object Mode do: the numbers of vertices and
    faces, and a checksum of the faces' corners.
    """
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    return len(mesh.vertices), len(mesh.polygons), zlib.crc32(corners.data)


def _number_of(data: bpy.types.ID | None) -> int:
    return data.session_uid if data else 0


def _is_edited(ob: bpy.types.Object) -> bool:
    """Tells whether the object or another one with the same data is in Edit Mode."""
    return ob.mode == "EDIT" or getattr(ob.data, "is_editmode", False)


def _layout_of(ob: bpy.types.Object) -> object:
    """Returns what differs where the data's elements are others, or are joined to others."""
    data = ob.data
    if ob.type == "MESH":
        if not data.is_editmode:
            return faces_of(data)
        edited = bmesh.from_edit_mesh(data)  # Blender writes it to the mesh at the end of the mode
        return len(edited.verts), len(edited.edges), len(edited.faces)
    if ob.type == "CURVES":
        sizes = np.empty(len(data.curves), np.int32)
        data.curves.foreach_get("points_length", sizes)
        return len(data.points), zlib.crc32(sizes.data)
    if ob.type == "POINTCLOUD":
        return len(data.points)
    if ob.type in ("CURVE", "SURFACE"):
        return [(each.type, each.use_cyclic_u, len(splines.points(each))) for each in data.splines]
    if ob.type == "LATTICE":
        return data.points_u, data.points_v, data.points_w
    if ob.type == "ARMATURE":
        return (data.edit_bones if data.is_editmode else data.bones).keys()
    return None


def _shape_of(ob: bpy.types.Object) -> int:
    """Returns a checksum of the positions of the points of hair, points, meshes and curves."""
    if ob.type in ("CURVE", "SURFACE"):
        return zlib.crc32(splines.positions(ob.data).tobytes())
    if ob.type == "MESH" and ob.data.is_editmode:
        with as_edited(ob.data) as mesh:
            return _sum_of(mesh, "position")
    return _sum_of(ob.data, "position")


def _sum_of(data: bpy.types.ID | None, name: str) -> int:
    """Returns a checksum of an attribute; -1 where there is none, or no data has any."""
    stored = getattr(data, "attributes", {}).get(name)
    if stored is None or stored.data_type not in attributes.LAYOUTS:
        return -1
    return zlib.crc32(np.ascontiguousarray(attributes.read(data, name)).data)
