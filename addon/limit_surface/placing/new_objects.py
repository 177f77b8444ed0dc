# SPDX-License-Identifier: GPL-3.0-or-later
"""New meshes, and new objects that belong to a surface."""

import bpy
import numpy as np

from .. import ids
from ..reading import attributes, ragged_rows
from . import dependencies

# From this version on normals can be stored as vectors; before, they are stored as angles of 16
# bits, from the mean normal of the corners of a vertex between sharp edges.
FREE_NORMALS = bpy.app.version >= (4, 5)


def add_on_surface(
    context: bpy.types.Context,
    name: str,
    data: bpy.types.ID,
    surface: bpy.types.Object,
    shown: bpy.types.Object | bpy.types.Collection | None = None,
) -> bpy.types.Object:
    """Adds an object that shares the surface's transform, makes it active and selects it alone.
    `shown` is that of which it will show instances. Blender has not evaluated the object yet: with
    many strands that takes longer than to make them, so it is for the caller to update the view
    layer once the object is complete.
    """
    ob = bpy.data.objects.new(name, data)
    put_on_surface(ob, surface)
    _collection(context, shown).objects.link(ob)
    if context.space_data and getattr(context.space_data, "local_view", None):
        ob.local_view_set(context.space_data, True)
    for other in context.selected_objects:
        other.select_set(False)
    ob.select_set(True)
    context.view_layer.objects.active = ob
    return ob


def put_on_surface(ob: bpy.types.Object, surface: bpy.types.Object) -> None:
    """Has an object share the surface's transform.

    Blender saves, and restores by undo, only those linked objects that have users, and a parent is
    none: a linked surface that is in no collection, or that is removed from it later, would be
    lost. A custom property is a user.
    """
    ob.parent = surface
    if surface.library is not None:
        ob[ids.LINKED_SURFACE] = surface


def add_polygons(
    mesh: bpy.types.Mesh, positions: np.ndarray, sizes: np.ndarray, vertices: np.ndarray
) -> None:
    """Fills an empty mesh with smooth polygons. `sizes` holds the number of corners of each
    polygon, `vertices` the vertex of each corner, polygon by polygon."""
    mesh.vertices.add(len(positions))
    mesh.loops.add(len(vertices))
    mesh.polygons.add(len(sizes))
    attributes.write(mesh, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)
    starts = ragged_rows.starts(sizes)
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(vertices, np.int32))
    mesh.polygons.foreach_set("loop_start", np.ascontiguousarray(starts, np.int32))
    mesh.update(calc_edges=True)
    _correct_edge_selection(mesh)
    mesh.shade_smooth()


def _correct_edge_selection(mesh: bpy.types.Mesh) -> None:
    """Has all edges selected, as Blender selects those that it makes. Blender 5.0 stores that with
    a wrong type, and crashes when something selects other edges.
    """
    stored = mesh.attributes.get(ids.EDGE_SELECTION)
    if stored and stored.data_type != "BOOLEAN":
        mesh.attributes.remove(stored)
        selected = np.ones(len(mesh.edges), bool)
        attributes.write(mesh, ids.EDGE_SELECTION, "BOOLEAN", "EDGE", selected)


def set_corner_normals(mesh: bpy.types.Mesh, normals: np.ndarray) -> None:
    """Sets the custom normals (n, 3) of all corners."""
    if FREE_NORMALS:
        attributes.write(mesh, ids.CUSTOM_NORMAL, "FLOAT_VECTOR", "CORNER", normals)
        mesh.update()
    else:
        mesh.normals_split_custom_set(normals)


def _collection(
    context: bpy.types.Context, shown: bpy.types.Object | bpy.types.Collection | None
) -> bpy.types.Collection:
    """Returns the active collection, or the scene's own where the active one is hidden, linked, or
    the override of a linked one, to which objects cannot be added, or where the object would show
    itself.
    """
    active = context.view_layer.active_layer_collection
    collection = active.collection
    takes_it = active.is_visible and collection.is_editable and not collection.override_library
    if takes_it and not (shown and collection in dependencies.collections_shown_by(shown)):
        return collection
    return context.scene.collection
