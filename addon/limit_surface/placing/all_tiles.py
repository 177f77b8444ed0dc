# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of all tiles of a surface, for users' own node trees, and a mesh of its faces."""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np

from .. import ids
from ..counting import counted
from ..errors import RefusalError
from ..nodes import groups, locate
from ..nodes.tiles import ROWS_OF_A_TILE
from ..reading import attributes, cage
from ..tasks.job import Progress
from ..tasks.object_keys import ObjectKey
from ..tasks.refused_faces import check_some_left
from . import following, new_objects, render_faces, tables

_NO_TILE = -(1 << 23)  # what quadtrees hold for faces that have no limit surface


class AllTiles:
    """The tables of one surface, in three steps: the surface is read from Blender, the tables are
    computed where Blender's data need not be touched, and written. Raises RefusalError for a
    surface that cannot have them; nothing has changed then.
    """

    def __init__(
        self,
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        depth: int,
        levels: int | None,
    ) -> None:
        """Takes the levels of the mesh of faces, or None to make no such mesh."""
        following.check_surface(surface, depsgraph.scene)
        render_faces.check(surface, depsgraph)
        self._surface, self._depth, self._levels = ObjectKey.of(surface), depth, levels
        with cage.opened(surface, depsgraph) as (found, mesh):
            self._bound = following.bound_to(found, mesh)
        self._limit = found.surface()
        check_some_left(self._limit, surface.name)

    def compute(self, progress: Progress) -> None:
        """Finds the tiles, which takes 30 to 65 microseconds of one core for each of them."""
        limit = self._limit
        try:
            self.tree = limit.tile_quadtree(self._depth, progress=progress)
        except ValueError as error:
            raise RefusalError(
                f"The tables of {self._surface.name} would take more than 3 GB, because a vertex "
                "has hundreds of faces, or a face hundreds of sides: choose a smaller depth, or "
                "divide such faces"
            ) from error
        if self._levels is None:
            return
        faces = np.flatnonzero(self.tree.child[: limit.face_count] != _NO_TILE)
        side = 2**self._levels
        self._face, self._uv = _grids(faces, side)
        self._positions = limit.evaluate(self._face, self._uv).position
        self._corners = _quads(len(faces), side)
        self._face_of_quad = np.repeat(faces, side * side)

    def write(self) -> bpy.types.Object:
        """Makes the tables, or makes them anew, and returns the table of tiles."""
        surface = self._surface.find()
        following.ensure_capture(surface)
        table = of_surface(surface)
        points = tables.PointsTable(self.tree.tiles, self._bound.vertices)
        holder = tables.points_of(table) if table else None
        holder = tables.hidden_object(ids.ALL_POINTS_TABLE, surface, holder)
        points.fill(holder.data)
        table = tables.hidden_object(ids.ALL_TILES_TABLE, surface, table)
        table[ids.ALL_TILES_MARK] = self._depth
        tables.connect(table, holder, surface, points, self._bound)
        self._fill(table.data, points.origin)
        if self._levels is not None:
            self._write_faces(surface)
        return table

    @property
    def surface(self) -> bpy.types.Object:
        return self._surface.find()

    @property
    def surface_name(self) -> str:
        return self._surface.name

    @property
    def topology(self) -> int:
        """Returns the checksum of the control mesh's edges that the tables hold."""
        return self._bound.topology

    @property
    def signature(self) -> str:
        """Returns following.signature of the control mesh."""
        return self._bound.signature

    def _fill(self, mesh: bpy.types.Mesh, origin: int) -> None:
        tree = self.tree
        tables.TilesTable(tree.tiles, origin, len(tree.child)).fill(mesh)
        rows = len(mesh.vertices)
        begin = np.repeat(tree.origin, ROWS_OF_A_TILE, axis=0)
        for name, kind, values in (
            (locate.CHILD, "INT", tree.child),
            (locate.ORIGIN, "FLOAT2", begin),
            (locate.LEVELS, "INT", np.full(rows, tree.levels)),
            (locate.FACES, "INT", np.full(rows, self._limit.face_count)),
            (ids.CAGE_TOPOLOGY, "INT", np.full(rows, self._bound.topology)),
        ):
            attributes.write(mesh, name, kind, "POINT", tables.padded(values, rows))

    def _write_faces(self, surface: bpy.types.Object) -> None:
        assert self._levels is not None
        ob = tables.hidden_object(ids.FACES_TABLE, surface, faces_of(surface))
        new_objects.put_on_surface(ob, surface)
        ob[ids.FACES_MARK] = self._levels
        mesh = ob.data
        mesh.clear_geometry()
        corners = self._corners.ravel()
        new_objects.add_polygons(mesh, self._positions, np.full(len(self._corners), 4), corners)
        attributes.write(mesh, ids.FACE, "INT", "FACE", self._face_of_quad)
        attributes.write(mesh, ids.UV, "FLOAT2", "CORNER", self._uv[corners])


class Settings(NamedTuple):
    """How the tables of a surface were made. None stands for what is not known."""

    depth: int | None
    levels: int | None


def settings_of(surface: bpy.types.Object) -> Settings:
    table, faces = of_surface(surface), faces_of(surface)
    levels = faces[ids.FACES_MARK] if faces else None
    # the first version of the extension stored True
    is_known = levels is not None and not isinstance(levels, bool)
    return Settings(table[ids.ALL_TILES_MARK] if table else None, levels if is_known else None)


def remove(surface: bpy.types.Object) -> list[str]:
    """Removes the tables of all tiles of a surface and the mesh of its faces, and returns the names
    of what has read them. Raises RefusalError where there are none.
    """
    found = [ob for ob in (of_surface(surface), faces_of(surface)) if ob is not None]
    if not found:
        raise RefusalError(f"{surface.name} has no tables for {ids.SAMPLE_GROUP}")
    readers = _remove(found)
    following.remove_unused_capture(surface)
    return readers


def left_behind() -> list[bpy.types.Object]:
    """Returns the file's own tables of all tiles, and meshes of faces, whose surface was
    deleted.
    """
    # to look for the group is quicker than to look at all objects
    if not any(groups.is_of(group, ids.TILES_GROUP) for group in bpy.data.node_groups):
        return []
    return [ob for ob in bpy.data.objects if _is_left_behind(ob)]


def remove_left_behind(but: bpy.types.Object | None = None) -> tuple[str, list[str]]:
    """Removes them, except for one that is about to become a surface. Returns a sentence for the
    report, or nothing where there are none, and the names of what has read them.
    """
    found = [ob for ob in left_behind() if ob != but]
    if not found:
        return "", []
    before = len(bpy.data.objects)
    readers = _remove(found)
    count = before - len(bpy.data.objects)
    return f"Removed {counted(count, 'hidden objects')} of meshes that were deleted", readers


def _is_left_behind(ob: bpy.types.Object) -> bool:
    if not (ob.hide_select and tables.is_own(ob)):
        return False
    if ids.ALL_TILES_MARK in ob:
        modifier = next(groups.modifiers(ob, ids.TILES_GROUP), None)
        if modifier is None or not groups.has_input(modifier, "Surface"):
            return False  # nothing tells whose table it is
        surface = tables.surface_of(ob)
    elif ids.FACES_MARK in ob:
        if tables.all_of_surface(ob):
            return False  # it has become a surface itself
        surface = ob.parent
    else:
        return False
    return surface is None or (_is_deleted(surface) and not tables.readers(ob))


def _is_deleted(surface: bpy.types.Object) -> bool:
    """Tells whether users have deleted the surface in a window. Blender keeps it then in the file,
    but in no collection, as long as tables refer to it; and nodes go on sampling it.
    """
    return not (surface.library or surface.users_collection or surface.use_fake_user)


def _remove(found: list[bpy.types.Object]) -> list[str]:
    """Removes these objects and the tables of points that they read. Returns the names of what has
    read them.
    """
    names = {reader.name for ob in found for reader in tables.readers(ob)}
    for ob in found:
        if ids.ALL_TILES_MARK in ob:
            tables.remove(ob)
        else:
            tables.remove_object(ob)
    return sorted(names)


def of_surface(surface: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the file's own table of all tiles of a surface, if there is one."""
    found = tables.all_of_surface(surface)
    return next((ob for ob in found if ids.ALL_TILES_MARK in ob), None)


def faces_of(surface: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the mesh of a surface's faces, if there is one."""
    return next((ob for ob in surface.children if ids.FACES_MARK in ob), None)


def _grids(faces: np.ndarray, side: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns the places of a grid of side x side quads on each face."""
    v, u = np.mgrid[: side + 1, : side + 1].reshape(2, -1) / side
    uv = np.stack([u, v], axis=1)
    return np.repeat(faces, len(uv)), np.tile(uv, (len(faces), 1))


def _quads(count: int, side: int) -> np.ndarray:
    """Returns the vertices (n, 4) of the quads of so many grids."""
    v, u = np.mgrid[:side, :side].reshape(2, -1)
    first = v * (side + 1) + u
    quad = np.stack([first, first + 1, first + side + 2, first + side + 1], axis=1)
    grid = (side + 1) ** 2 * np.arange(count)
    return (grid[:, None, None] + quad).reshape(-1, 4)
