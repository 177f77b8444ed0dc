# SPDX-License-Identifier: GPL-3.0-or-later
"""A tessellation as a mesh of Blender."""

from __future__ import annotations

import bpy
import numpy as np

from .. import ids
from ..placing import new_objects
from ..reading import attributes, ragged_rows, vertex_weights
from . import cage_attributes
from .tessellation import Made

_SAME = 1e-4  # components of normals that differ by less count as equal


def build(made: Made, source: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bpy.types.Mesh:
    """Builds the mesh, without its locations. If that fails, no mesh is left in the file."""
    mesh = bpy.data.meshes.new(ids.LIMIT_MESH_OBJECT)
    try:
        of = made.tessellation
        new_objects.add_polygons(mesh, of.positions, of.face_sizes, of.face_vertices)
        for each in made.attributes:
            cage_attributes.write(mesh, each)
        for each in made.carrier.on_edges(mesh):
            cage_attributes.write(mesh, each)
        if made.groups.names:
            grouped = vertex_weights.with_groups(
                mesh, made.groups.names, made.groups.weights, depsgraph
            )
            bpy.data.meshes.remove(mesh)
            mesh = grouped
            mesh.name = ids.LIMIT_MESH_OBJECT
        _activate_as(source.data, mesh)
        for key in made.materials:
            mesh.materials.append(key.find() if key else None)
        on = made.tessellation
        if on.corner_normals is not None:
            _set_normals(mesh, on.corner_normals, on.face_sizes)
    except BaseException:
        bpy.data.meshes.remove(mesh)
        raise
    return mesh


def copy_object_materials(source: bpy.types.Object, target: bpy.types.Object) -> None:
    """Copies the materials that belong to the object rather than to its mesh. Modifiers may have
    made other slots than the object has.
    """
    for own, slot in zip(source.material_slots, target.material_slots, strict=False):
        if own.link == "OBJECT":
            slot.link, slot.material = "OBJECT", own.material


def _activate_as(source: bpy.types.Mesh, mesh: bpy.types.Mesh) -> None:
    """Makes the same UV maps and colours active, and active for rendering."""
    for layer in source.uv_layers:
        made = mesh.uv_layers.get(layer.name)
        if made and layer.active_render:
            made.active_render = True
    active = source.uv_layers.active
    if active and active.name in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[active.name]
    colours = mesh.color_attributes
    if source.color_attributes.active_color_name in colours:
        colours.active_color_name = source.color_attributes.active_color_name
    rendered = source.color_attributes.render_color_index
    if 0 <= rendered < len(source.color_attributes):
        name = source.color_attributes[rendered].name
        if name in colours:
            colours.render_color_index = colours.find(name)


def _set_normals(mesh: bpy.types.Mesh, normals: np.ndarray, face_sizes: np.ndarray) -> None:
    """Sets the custom normals. Edges at which normals differ become sharp, because Cycles keeps
    several normals at a vertex only there.
    """
    edge = attributes.read(mesh, ids.CORNER_EDGE)
    part = _parting(edge, normals, normals[ragged_rows.following(face_sizes)], len(mesh.edges))
    if ids.SHARP_EDGE in mesh.attributes:  # sharp edges of the cage
        part |= attributes.read(mesh, ids.SHARP_EDGE)
    attributes.write(mesh, ids.SHARP_EDGE, "BOOLEAN", "EDGE", part)
    new_objects.set_corner_normals(mesh, normals)


def _parting(
    edge: np.ndarray, at_corner: np.ndarray, at_next: np.ndarray, count: int
) -> np.ndarray:
    """Returns which edges have polygons on their two sides whose normals differ at an end. `edge`
    holds for each corner the edge that leads to the next one.
    """
    order = np.argsort(edge, kind="stable")
    paired = edge[order[1:]] == edge[order[:-1]]
    one, other = order[:-1][paired], order[1:][paired]
    apart = np.maximum(
        np.abs(at_corner[one] - at_next[other]).max(axis=1),
        np.abs(at_next[one] - at_corner[other]).max(axis=1),
    )
    part = np.zeros(count, bool)
    part[edge[one[apart > _SAME]]] = True
    return part
