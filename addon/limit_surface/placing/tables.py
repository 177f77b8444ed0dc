# SPDX-License-Identifier: GPL-3.0-or-later
"""The two tables by which Geometry Nodes evaluate a limit surface: objects of vertices only.

*Limit Points* holds what the tiles consist of: a vertex for each vertex of the control mesh, one
for each refined point, and after them the terms of the refined points' sums, three on a vertex.
*Limit Tiles* holds four vertices for each bicubic tile; its modifier makes their matrices. All that
follows one surface shares these tables.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import ids
from ..nodes import groups
from ..nodes import tiles as nodes
from ..nodes.tiles import TILES
from ..reading import attributes, ragged_rows
from ..reading.users import objects_using, own_objects_using

if TYPE_CHECKING:
    import limitsurf

TERMS_ON_A_VERTEX = len(nodes.TERMS)


@dataclass(frozen=True)
class Bound:
    """What the tables are made for, as numbers that are compared with the surface in each frame."""

    vertices: int
    topology: int  # nodes.capture.topology_sum
    #: nodes.capture.crease_sum of edges and of vertices; None where creases cannot be guarded
    creases: tuple[int, int] | None
    signature: str  # of the topology and the rules of subdivision


class PointsTable:
    """The vertices of *Limit Points* as arrays."""

    def __init__(self, tiles: limitsurf.Tiles, vertices: int) -> None:
        sizes = np.diff(tiles.points_offsets)
        count = len(sizes)
        indices, weights = tiles.points_indices, tiles.points_weights
        row_of_term = np.repeat(np.arange(count), sizes)
        total = np.bincount(row_of_term, weights, minlength=count)
        base = np.zeros(count, np.int64)
        largest = _largest(np.abs(weights), sizes)
        base[sizes > 0] = indices[largest]

        # the terms of each refined point fill whole vertices; the places left over weigh nothing
        used = -(-sizes // TERMS_ON_A_VERTEX)
        first = ragged_rows.starts(used) * TERMS_ON_A_VERTEX
        slot = first[row_of_term] + ragged_rows.places(sizes)
        term_vertices = int(used.sum())
        of_terms = np.repeat(np.arange(count), used)
        term_index = np.repeat(base[of_terms], TERMS_ON_A_VERTEX)
        term_weight = np.zeros(term_vertices * TERMS_ON_A_VERTEX)
        term_index[slot], term_weight[slot] = indices, weights

        self.refined = count + 1  # one more, without terms, is the origin
        self.origin = vertices + count
        begin, end = vertices + count + 1, vertices + count + 1 + term_vertices
        self.position = np.zeros((end, 3))
        self.position[begin:] = term_weight.reshape(-1, TERMS_ON_A_VERTEX)
        # the vertices of the control mesh belong to no refined point
        self.row = np.full(end, -1)
        self.row[vertices:begin] = np.arange(count + 1)
        self.row[begin:] = of_terms
        self.terms = np.zeros((end, TERMS_ON_A_VERTEX), np.int64)
        self.terms[vertices : vertices + count, 0] = base
        self.terms[vertices : vertices + count, 1] = np.rint(total)
        self.terms[begin:] = term_index.reshape(-1, TERMS_ON_A_VERTEX)

    def fill(self, mesh: bpy.types.Mesh) -> None:
        fill(mesh, self.position)
        attributes.write(mesh, nodes.ROW, "INT", "POINT", self.row)
        for name, values in zip(nodes.TERMS, self.terms.T, strict=True):
            attributes.write(mesh, name, "INT", "POINT", values)


class TilesTable:
    """The vertices of *Limit Tiles* as arrays."""

    def __init__(self, tiles: limitsurf.Tiles, origin: int, least: int = 0) -> None:
        """Takes the point that is the origin. There are at least so many vertices."""
        count = len(tiles.tile_points)
        # by rows: x counts along u, and a row runs along v
        self.control = np.swapaxes(tiles.tile_points.reshape(-1, 4, 4), 1, 2)
        self.base = np.repeat(self.control[:, :1], 4, axis=1)
        self.base[:, 0] = tiles.tile_base[:, None]
        self.anchor = np.full((count, 4), origin)
        self.anchor[:, 0] = tiles.tile_anchor
        self.least = least
        self.scale = np.zeros((count, 2))
        self.scale[tiles.tile] = tiles.scale

    def fill(self, mesh: bpy.types.Mesh) -> None:
        rows = max(self.anchor.size, self.least)
        fill(mesh, np.zeros((rows, 3)))
        for names, values in ((nodes.CONTROL, self.control), (nodes.BASE, self.base)):
            for name, column in zip(names, values.reshape(-1, 4).T, strict=True):
                attributes.write(mesh, name, "INT", "POINT", padded(column, rows))
        anchor = padded(self.anchor.ravel(), rows)
        attributes.write(mesh, nodes.ANCHOR, "INT", "POINT", anchor)
        scale = np.repeat(self.scale, nodes.ROWS_OF_A_TILE, axis=0)
        attributes.write(mesh, nodes.SCALE, "FLOAT2", "POINT", padded(scale, rows))


def padded(values: np.ndarray, rows: int) -> np.ndarray:
    """Returns the values with zeros after them, so many rows in all."""
    missing = rows - len(values)
    return np.concatenate([values, np.zeros((missing, *values.shape[1:]), values.dtype)])


def of_surface(surface: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the file's own table of the tiles that followers of a surface use, if there is
    one.
    """
    return next((ob for ob in all_of_surface(surface) if ids.ALL_TILES_MARK not in ob), None)


def all_of_surface(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns all of the file's own tables of tiles of a surface."""
    return [ob for ob in own_objects_using(surface) if is_own(ob) and surface_of(ob) == surface]


def is_own(ob: bpy.types.Object) -> bool:
    """Tells whether the object and its data belong to this file. The data of library overrides do
    not.
    """
    return ob.library is None and ob.data is not None and ob.data.library is None


def surface_of(table: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the surface of a table of tiles, or None for any other object."""
    modifier = next(groups.modifiers(table, ids.TILES_GROUP), None)
    return groups.get_input(modifier, "Surface") if modifier else None


def write(surface: bpy.types.Object, tiles: limitsurf.Tiles, bound: Bound) -> bpy.types.Object:
    """Makes the tables of a surface, or makes them anew, and returns the table of tiles."""
    table = of_surface(surface)
    points = PointsTable(tiles, bound.vertices)
    held = points_of(table) if table else _unread_points(surface)
    if held is not None and not is_own(held):
        held = None
    holder = hidden_object(ids.POINTS_TABLE, surface, held)
    points.fill(holder.data)
    table = hidden_object(ids.TILES_TABLE, surface, table)
    connect(table, holder, surface, points, bound)
    TilesTable(tiles, points.origin).fill(table.data)
    return table


def connect(
    table: bpy.types.Object,
    holder: bpy.types.Object,
    surface: bpy.types.Object,
    points: PointsTable,
    bound: Bound,
) -> None:
    """Makes a table of tiles read its surface and the holder of its points."""
    modifier = next(groups.modifiers(table, ids.TILES_GROUP), None)
    if modifier is None:
        modifier = groups.add_modifier(table, TILES)
    elif not TILES.matches(modifier.node_group):
        modifier.node_group = TILES.group()
    edge_creases, vertex_creases = bound.creases or (0, 0)
    for name, value in (
        ("Surface", surface),
        ("Points", holder),
        ("Cage Count", bound.vertices),
        ("Cage Topology", bound.topology),
        (nodes.GUARDS_CREASES, bound.creases is not None),
        ("Cage Edge Creases", edge_creases),
        ("Cage Vertex Creases", vertex_creases),
        ("Refined Points", points.refined),
    ):
        groups.set_input(modifier, name, value)
    table[ids.SIGNATURE] = bound.signature


def points_of(table: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the table of points that a table of tiles reads, if there is one."""
    modifier = next(groups.modifiers(table, ids.TILES_GROUP), None)
    return groups.get_input(modifier, "Points") if modifier else None


def fits(table: bpy.types.Object) -> bool:
    """Tells whether the nodes have found, when they were evaluated last, that the table fits its
    surface.
    """
    depsgraph = bpy.context.view_layer.depsgraph
    shown = table.evaluated_get(depsgraph).data.attributes.get(ids.CAGE_FITS)
    return shown is None or bool(shown.data[0].value)


def size_in_bytes(table: bpy.types.Object) -> int:
    """Returns how much both tables hold."""
    return sum(
        attributes.size_in_bytes(attribute)
        for ob in (table, points_of(table))
        if ob is not None
        for attribute in ob.data.attributes
    )


def _unread_points(surface: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the table of points that is left of a surface whose table of tiles was deleted."""
    ob = bpy.data.objects.get((_name(ids.POINTS_TABLE, surface), None))
    if ob is None or ob.type != "MESH" or nodes.ROW not in ob.data.attributes:
        return None
    return None if any(points_of(other) == ob for other in objects_using(ob)) else ob


def remove(table: bpy.types.Object) -> None:
    """Removes both tables from the file."""
    for ob in (points_of(table), table):
        if ob is not None:
            remove_object(ob)


def readers(table: bpy.types.Object) -> list[bpy.types.ID]:
    """Returns the objects and node groups that refer to the table."""
    users = bpy.data.user_map(subset=[table])[table]
    return [user for user in users if user.id_type in ("OBJECT", "NODETREE", "MATERIAL")]


def unread() -> list[bpy.types.Object]:
    """Returns the tables of live children and of Curve objects that nothing reads: what read them
    was deleted.
    """
    names = tuple(f"{kind} of " for kind in (ids.CHILDREN_TABLE, ids.CURVE_TABLE))
    found = [
        ob
        for ob in bpy.data.objects
        if ob.hide_select and ob.name.startswith(names) and ob.type == "MESH" and is_own(ob)
    ]
    return [ob for ob in found if not readers(ob)]


def remove_unread() -> None:
    """Removes these tables from the file."""
    for table in unread():
        remove_object(table)


def remove_object(table: bpy.types.Object) -> None:
    """Removes a table from the file, and its mesh if nothing else uses it."""
    mesh = table.data
    bpy.data.objects.remove(table)
    if not mesh.users:
        bpy.data.meshes.remove(mesh)


def hidden_object(
    kind: str, whose: bpy.types.Object, found: bpy.types.Object | None = None
) -> bpy.types.Object:
    """Returns a hidden object that belongs to another one: what was found, or a new object with an
    empty mesh. It is named after its owner, which may have been renamed since.

    It stands in the scene's own collection, never beside its owner. Blender makes a rigid body of
    whatever comes into the collection of the rigid bodies, and users put the members of collections
    on points. Nodes evaluate the objects that they read wherever these are.
    """
    ob = found
    if ob is None:
        name = _name(kind, whose)
        ob = bpy.data.objects.new(name, bpy.data.meshes.new(name))
        ob.hide_viewport = ob.hide_render = ob.hide_select = True
    elif ob.name.startswith(f"{kind} of "):
        _rename(ob, _name(kind, whose))
    home = bpy.context.scene.collection
    # earlier versions of the extension put it beside its owner
    for collection in set(ob.users_collection).intersection(whose.users_collection) - {home}:
        # objects cannot be removed from the overrides of linked collections
        if collection.is_editable and not collection.override_library:
            collection.objects.unlink(ob)
    if not ob.users_collection:
        home.objects.link(ob)
    return ob


def _rename(ob: bpy.types.Object, name: str) -> None:
    """Renames a hidden object. Another hidden object that has the name gets the old one: if two
    surfaces have changed names, both objects are then named after their owners.
    """
    before = ob.name
    if before == name:
        return
    other = bpy.data.objects.get((name, None))
    is_hidden = other is not None and other.hide_select and other.hide_viewport
    if other is not None and is_hidden and is_own(other):
        ob.name = f"{before}*"
        other.name = before
    ob.name = name
    if ob.data.users == 1:
        ob.data.name = ob.name


def copy_of(table: bpy.types.Object, kind: str, whose: bpy.types.Object) -> bpy.types.Object:
    """Returns a hidden object with a copy of the table's mesh."""
    ob = hidden_object(kind, whose)
    empty, ob.data = ob.data, table.data.copy()
    bpy.data.meshes.remove(empty)
    ob.data.name = ob.name
    return ob


def _name(kind: str, whose: bpy.types.Object) -> str:
    return f"{kind} of {whose.name}"


def fill(mesh: bpy.types.Mesh, positions: np.ndarray) -> None:
    """Replaces the mesh's elements by vertices at these positions."""
    mesh.clear_geometry()
    mesh.vertices.add(len(positions))
    attributes.write(mesh, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)


def _largest(values: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Returns the index of the largest value of each row that is not empty, the last such one."""
    filled = sizes[sizes > 0]
    if not len(filled):
        return np.empty(0, np.int64)
    ends = np.cumsum(filled)
    largest = np.maximum.reduceat(values, ends - filled)
    found = np.flatnonzero(values == np.repeat(largest, filled))
    return found[np.searchsorted(found, ends) - 1]
