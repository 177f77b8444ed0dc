# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of meshes and curves as whole numpy arrays."""

from collections.abc import Mapping
from typing import NamedTuple

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError


class Layout(NamedTuple):
    key: str  # the name of the property that holds an element's value
    width: int
    dtype: type


LAYOUTS = {
    "FLOAT": Layout("value", 1, np.float32),
    "INT": Layout("value", 1, np.int32),
    "INT8": Layout("value", 1, np.int8),
    "BOOLEAN": Layout("value", 1, bool),
    "INT32_2D": Layout("value", 2, np.int32),
    "FLOAT2": Layout("vector", 2, np.float32),
    "FLOAT_VECTOR": Layout("vector", 3, np.float32),
    "QUATERNION": Layout("value", 4, np.float32),
    "FLOAT_COLOR": Layout("color", 4, np.float32),
    "BYTE_COLOR": Layout("color", 4, np.float32),
}


def write(data: bpy.types.ID, name: str, kind: str, domain: str, values: np.ndarray) -> None:
    """Creates the attribute, or overwrites it, with one row of `values` for each element of the
    domain. An attribute of another type or domain is replaced if its name is one of this
    extension's. Otherwise it is the user's, and RefusalError is raised.
    """
    attribute = data.attributes.get(name)
    if attribute and (attribute.data_type, attribute.domain) != (kind, domain):
        if not name.startswith(ids.ATTRIBUTE_PREFIX):
            raise RefusalError(
                f"{data.name} has an attribute {name} of another type or domain than is needed "
                f"({kind}, {domain}): rename or remove it"
            )
        data.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = add(data, name, kind, domain)
    layout = LAYOUTS[kind]
    values = np.ascontiguousarray(values, layout.dtype)
    if values.size != len(attribute.data) * layout.width:
        raise ValueError(f"{name}: {values.shape} values for {len(attribute.data)} elements")
    attribute.data.foreach_set(layout.key, values.ravel())


def add(data: bpy.types.ID, name: str, kind: str, domain: str) -> bpy.types.Attribute:
    """Creates an attribute that does not exist yet. Raises RefusalError where a vertex group has
    its name: attributes and vertex groups must not have the same.
    """
    made = data.attributes.new(name, kind, domain)
    if made and made.name == name:
        return made
    if made:  # Blender 5.2 gives it another name, earlier ones make none
        data.attributes.remove(made)
    raise RefusalError(f"{data.name} has a vertex group {name}: rename or remove it")


def read(data: bpy.types.ID, name: str) -> np.ndarray:
    """Returns the attribute's values, (n,) or (n, width). Raises KeyError where there is none of
    that name.
    """
    attribute = data.attributes[name]
    layout = LAYOUTS[attribute.data_type]
    values: np.ndarray = np.empty(len(attribute.data) * layout.width, layout.dtype)
    attribute.data.foreach_get(layout.key, values)
    return values if layout.width == 1 else values.reshape(-1, layout.width)


def curve_offsets(data: bpy.types.Curves) -> np.ndarray:
    """Returns the first point of each curve, and the number of all points at the end (n + 1,)."""
    offsets = np.zeros(len(data.curves) + 1, np.int32)
    if len(data.curves):  # Blender stores nothing for data without curves
        data.curve_offset_data.foreach_get("value", offsets)
    return offsets


def edge_ends(mesh: bpy.types.Mesh) -> np.ndarray:
    """Returns the vertices of the edges (n, 2). Blender stores nothing for a mesh without edges."""
    if ids.EDGE_VERTICES not in mesh.attributes:
        return np.empty((0, 2), np.int32)
    return read(mesh, ids.EDGE_VERTICES)


def size_in_bytes(attribute: bpy.types.Attribute) -> int:
    layout = LAYOUTS[attribute.data_type]
    return len(attribute.data) * layout.width * np.dtype(layout.dtype).itemsize


def check_names(ob: bpy.types.Object, kinds: Mapping[str, str], domain: str) -> None:
    """Raises RefusalError where one of these names, under which attributes of these types are to be
    written, belongs to a vertex group or to an attribute of another type or domain.
    """
    data = ob.data
    for name, kind in kinds.items():
        there = data.attributes.get(name)
        if there and (there.data_type, there.domain) != (kind, domain):
            raise RefusalError(
                f"{data.name} has an attribute {name} of another type or domain "
                f"({there.data_type} on {there.domain}): rename or remove it"
            )
        if name in ob.vertex_groups:  # vertex groups and attributes must not have the same name
            raise RefusalError(f"{ob.name} has a vertex group {name}: rename or remove it")


def face_sizes(mesh: bpy.types.Mesh) -> np.ndarray:
    values = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", values)
    return values
