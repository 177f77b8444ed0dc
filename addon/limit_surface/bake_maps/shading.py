# SPDX-License-Identifier: GPL-3.0-or-later
"""What renderers interpolate on the polygons that a tangent-space normal map is for: the normals,
MikkTSpace's tangents and their signs at the polygons' corners.

The polygons become triangles on the UV map, and the image's texels are found on them as they are on
the limit surface: a mesh of triangles that is not smoothed has a limit surface, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import bpy
import numpy as np

from .. import ids, native
from ..errors import RefusalError
from ..images import texel_places
from ..reading import attributes, cage, displayed_mesh, rules
from ..tasks.job import Progress

if TYPE_CHECKING:
    import limitsurf

Kind = displayed_mesh.Kind | Literal["CAGE"]


@dataclass(frozen=True)
class Corners:
    """The corners of the triangles, three for each."""

    uv: np.ndarray  # (3 t, 2)
    normal: np.ndarray  # (3 t, 3)
    tangent: np.ndarray  # (3 t, 3)
    sign: np.ndarray  # (3 t,)


@dataclass(frozen=True)
class Shading:
    """Normals and tangents at the texels of one tile of the image."""

    texels: limitsurf.Texels
    columns: np.ndarray  # (n, 7) normal, tangent, sign

    def tangent_space(self, rows: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Returns the normals as the map has to hold them."""
        c = self.columns[rows]
        return native.limitsurf.into_shading_frames(normals, c[:, :3], c[:, 3:6], c[:, 6])


class Polygons:
    def __init__(self, corners: Corners) -> None:
        count = len(corners.uv)
        flat = np.concatenate([corners.uv, np.zeros((count, 1))], axis=1)
        own = np.arange(count)
        surface = native.limitsurf.LimitSurface(
            native.limitsurf.ControlMesh(flat, np.full(count // 3, 3), own, scheme="bilinear")
        )
        self._uv = surface.face_varying(corners.uv, own, rules.LINEAR)
        columns = np.concatenate(
            [corners.normal, corners.tangent, corners.sign[:, None]], axis=1, dtype=np.float64
        )
        self._columns = surface.face_varying(columns, own, rules.LINEAR)

    def over(self, size: tuple[int, int], tile: int, margin: float, progress: Progress) -> Shading:
        """Returns the shading under texels. Where polygons overlap, one of them is taken."""
        found = texel_places.texels(
            self._uv, size, tile, margin=margin, allow_overlap=True, progress=progress
        )
        return Shading(found, self._columns.evaluate(found.face, found.uv).value)


def read(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph, kind: Kind, uv_name: str) -> Corners:
    """Reads the polygons. `kind` is CAGE for the mesh before the subdivision, and VIEWPORT or
    RENDER for the mesh after it. Raises RefusalError where the mesh has no tangents.
    """
    with _opened(ob, depsgraph, kind) as (mesh, whose):
        if uv_name not in mesh.uv_layers:
            raise RefusalError(f"{whose} has no UV map {uv_name!r}")
        return _corners(mesh, uv_name)


@contextmanager
def _opened(
    ob: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    kind: Kind,
) -> Iterator[tuple[bpy.types.Mesh, str]]:
    if kind == "CAGE":
        with cage.opened(ob, depsgraph) as (_, mesh):
            yield mesh, f"{ob.name}: the mesh before the subdivision"
    else:
        with displayed_mesh.opened(ob, depsgraph, kind) as (mesh, _, whose):
            yield mesh, whose


def _corners(mesh: bpy.types.Mesh, uv_name: str) -> Corners:
    """Returns the corners with the tangents of the triangles that are drawn. Cycles calculates them
    so, as do programs that triangulate a mesh first. (Blender itself, and Eevee, calculate the
    tangents of whole quads.)
    """
    mesh.calc_loop_triangles()
    corners = _of(mesh.loop_triangles, "loops", 3, np.int32).ravel()
    flat = attributes.read(mesh, "sharp_face") if "sharp_face" in mesh.attributes else False
    flat = np.broadcast_to(flat, len(mesh.polygons))[
        _of(mesh.loop_triangles, "polygon_index", 1, np.int32).ravel()
    ]
    uv = attributes.read(mesh, uv_name)[corners]
    twin = bpy.data.meshes.new(ids.TEMPORARY_MESH)
    try:
        vertex = attributes.read(mesh, ids.CORNER_VERTEX)[corners]
        twin.from_pydata(attributes.read(mesh, ids.POSITION), [], vertex.reshape(-1, 3))
        twin.polygons.foreach_set("use_smooth", ~flat)
        twin.update()
        # A polygon with flat shading is flat on each of its triangles.
        normal = np.where(
            np.repeat(flat, 3)[:, None],
            _of(twin.corner_normals, "vector", 3),
            _of(mesh.corner_normals, "vector", 3)[corners],
        )
        # Setting normals moves layers in memory, so no reference to one is kept.
        twin.uv_layers.new(name=uv_name).uv.foreach_set("vector", uv.ravel())
        twin.normals_split_custom_set(normal)
        twin.calc_tangents(uvmap=uv_name)
        tangent, sign = _of(twin.loops, "tangent", 3), _of(twin.loops, "bitangent_sign", 1)
    finally:
        bpy.data.meshes.remove(twin)
    return Corners(uv.astype(np.float64), normal, tangent, sign.ravel())


def _of(
    data: bpy.types.bpy_prop_collection, key: str, width: int, dtype: type = np.float32
) -> np.ndarray:
    values: np.ndarray = np.empty(width * len(data), dtype)
    data.foreach_get(key, values)
    return values.reshape(-1, width)
