# SPDX-License-Identifier: GPL-3.0-or-later
"""The normals that Cycles interpolates on the triangles of a mesh.

Blender's own corner normals, which the viewport shows, are often others:
- From Blender 5.2 on, Cycles takes them.
- In 5.1 it takes them where an edge is sharp or a normal is custom. Elsewhere it has one normal for
  each vertex, so that polygons are smoothed over their edges with flat ones.
- Up to 5.0 it has one normal for each vertex everywhere. Where an edge is sharp or a normal is
  custom, it splits vertices at sharp edges and around flat polygons first.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np

from .. import ids
from ..reading import attributes

_TAKES_CORNER_NORMALS = bpy.app.version >= (5, 1)
_NEVER_SMOOTHS_OVER_FLAT_POLYGONS = bpy.app.version >= (5, 2)

# From this version on, normals are made unit vectors after they are interpolated, and tangents not.
MAKES_UNIT_NORMALS = bpy.app.version >= (5, 1)


class Triangles(NamedTuple):
    corner: np.ndarray  # (3 t,) corners of the mesh
    polygon: np.ndarray  # (t,)
    normal: np.ndarray  # (t, 3) the unit normals of the triangles themselves


def triangles(mesh: bpy.types.Mesh) -> Triangles:
    """Returns the triangles that are drawn."""
    mesh.calc_loop_triangles()
    drawn = mesh.loop_triangles
    return Triangles(
        column(drawn, "loops", 3, np.int32).ravel(),
        column(drawn, "polygon_index", 1, np.int32).ravel(),
        column(drawn, "normal", 3),
    )


def at_corners(mesh: bpy.types.Mesh, drawn: Triangles) -> np.ndarray:
    """Returns the normals (3 t, 3) at the corners of the triangles. Custom ones may have another
    length than 1.
    """
    flat = np.repeat(drawn.normal, 3, axis=0)
    if mesh.normals_domain == "FACE":
        return flat
    if mesh.normals_domain == "POINT" or _smooths_over_flat_polygons(mesh):
        vertex = attributes.read(mesh, ids.CORNER_VERTEX)[drawn.corner]
        smooth = column(mesh.vertex_normals, "vector", 3)[vertex]
        return np.where(np.repeat(_are_flat(mesh)[drawn.polygon], 3)[:, None], flat, smooth)
    # Here polygons with flat shading have their normal at all corners, on bent polygons too.
    if _TAKES_CORNER_NORMALS:
        return column(mesh.corner_normals, "vector", 3)[drawn.corner]
    return _of_split_vertices(mesh)[drawn.corner]


def at_corners_for_tangents(
    mesh: bpy.types.Mesh, drawn: Triangles, normal: np.ndarray
) -> np.ndarray:
    """Returns the normals at the corners for which tangents are calculated, where `normal` holds
    those that are interpolated: on polygons with flat shading they are the triangles' own ones.
    """
    if not _TAKES_CORNER_NORMALS:
        return normal
    flat = np.repeat(drawn.normal, 3, axis=0)
    return np.where(np.repeat(_are_flat(mesh)[drawn.polygon], 3)[:, None], flat, normal)


def _smooths_over_flat_polygons(mesh: bpy.types.Mesh) -> bool:
    if _NEVER_SMOOTHS_OVER_FLAT_POLYGONS or mesh.has_custom_normals:
        return False
    return not (ids.SHARP_EDGE in mesh.attributes and attributes.read(mesh, ids.SHARP_EDGE).any())


def _are_flat(mesh: bpy.types.Mesh) -> np.ndarray:
    if ids.SHARP_FACE in mesh.attributes:
        return attributes.read(mesh, ids.SHARP_FACE)
    return np.zeros(len(mesh.polygons), bool)


def _of_split_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """Returns for each corner of the mesh the normal of its vertex after splitting: that of the
    vertex's last corner.
    """
    split = mesh.copy()
    try:
        split.split_faces()
        vertex = attributes.read(split, ids.CORNER_VERTEX)
        normal = column(split.corner_normals, "vector", 3)
    finally:
        bpy.data.meshes.remove(split)
    last = np.empty(vertex.max() + 1, np.intp)
    last[vertex] = np.arange(len(vertex))
    return normal[last[vertex]]


def unit(vectors: np.ndarray) -> np.ndarray:
    """Returns unit vectors. Those without a length stay as they are."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=vectors.copy(), where=length > 0)


def column(
    data: bpy.types.bpy_prop_collection, key: str, width: int, dtype: type = np.float32
) -> np.ndarray:
    """Returns a property of all elements, (n, width)."""
    values: np.ndarray = np.empty(width * len(data), dtype)
    data.foreach_get(key, values)
    return values.reshape(-1, width)
