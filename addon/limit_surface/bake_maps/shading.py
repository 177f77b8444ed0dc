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
from ..placing import new_objects
from ..reading import attributes, cage, displayed_mesh, rules
from ..tasks.job import Progress
from . import shaded_normals

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
        columns = self._columns.evaluate(found.face, found.uv).value
        if shaded_normals.MAKES_UNIT_NORMALS:
            columns[:, :3] = shaded_normals.unit(columns[:, :3])
        return Shading(found, columns)


def read(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph, kind: Kind, uv_name: str) -> Corners:
    """Reads the polygons. `kind` is CAGE for the mesh before the subdivision, and VIEWPORT or
    RENDER for the mesh after it. Raises RefusalError where the mesh has no tangents.
    """
    with _opened(ob, depsgraph, kind) as (mesh, whose):
        if uv_name not in mesh.uv_layers:
            raise RefusalError(f"{whose} has no UV map {uv_name!r}")
        corners = _corners(mesh, uv_name)
    if not (np.isfinite(corners.tangent).all() and np.isfinite(corners.normal).all()):
        raise RefusalError(
            f"{whose} has tangents that are not finite numbers: its coordinates are too large"
        )
    return corners


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
    drawn = shaded_normals.triangles(mesh)
    normal = shaded_normals.at_corners(mesh, drawn)
    guide = shaded_normals.at_corners_for_tangents(mesh, drawn, normal)
    uv = attributes.read(mesh, uv_name)[drawn.corner]
    vertex = attributes.read(mesh, ids.CORNER_VERTEX)[drawn.corner]
    positions = attributes.read(mesh, ids.POSITION)
    if not new_objects.FREE_NORMALS:
        chosen, vertex = _split(vertex, guide)
        positions = positions[chosen]
    twin = bpy.data.meshes.new(ids.TEMPORARY_MESH)
    try:
        new_objects.add_polygons(twin, positions, np.full(len(drawn.polygon), 3), vertex)
        # Setting normals moves layers in memory, so no reference to one is kept.
        twin.uv_layers.new(name=uv_name).uv.foreach_set("vector", uv.ravel())
        new_objects.set_corner_normals(twin, guide)
        twin.calc_tangents(uvmap=uv_name)
        tangent = shaded_normals.column(twin.loops, "tangent", 3)
        sign = shaded_normals.column(twin.loops, "bitangent_sign", 1)
    finally:
        bpy.data.meshes.remove(twin)
    return Corners(uv.astype(np.float64), shaded_normals.unit(normal), tangent, sign.ravel())


def _split(vertex: np.ndarray, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Splits vertices until each has one normal. MikkTSpace takes the mean of tangents at corners
    whose normals are equal to the last bit, and Blender rounds the normals of a vertex to the same
    16 bits only where all its corners have the same one.

    Returns the old vertex of each new one, and the new vertices of the corners.
    """
    rows = np.column_stack([vertex.astype(np.int32), (normal + 0.0).view(np.int32)])
    rows = np.ascontiguousarray(rows).view([("", np.int32)] * rows.shape[1]).ravel()
    _, first, new = np.unique(rows, return_index=True, return_inverse=True)
    return vertex[first], new.ravel()
