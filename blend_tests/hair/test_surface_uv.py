# SPDX-License-Identifier: GPL-3.0-or-later
"""surface_uv_coordinate leads Blender's nodes to the root: they look it up on the evaluated mesh,
whose UV map is smoothed if there is a subdivision.
"""

from pathlib import Path

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.nodes import groups
from limit_surface.reading import attributes, rules
from scenes import add_hair, add_subsurf

LEVELS = 6  # polygons of 1/64 of a face are within 1e-3 of the surface that they approximate
NEAR = 1e-3
ASSETS = "datafiles/assets/**/procedural_hair_node_assets.blend"


def bent(positions):
    """Returns a map that is one to one on the sheet, and far from affine."""
    x, y = positions[:, 0], positions[:, 1]
    return np.stack([x + 0.2 * np.sin(3 * y + x), y + 0.2 * np.cos(2.5 * x)], axis=1) / 8 + 0.1


@pytest.fixture
def sheet():
    ob = scenes.grid_with_holes()
    scenes.add_uv_map(ob, bent)
    subsurf = add_subsurf(ob, "PRESERVE_CORNERS")
    subsurf.levels, subsurf.quality = LEVELS, 10
    return ob


def new_group():
    group = bpy.data.node_groups.new("Looks", "GeometryNodeTree")
    group.is_modifier = True
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    return group, group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")


def sampling_group(ob):
    """Makes a node group that stores where the node Sample UV Surface finds each curve's UV on the
    object.
    """
    group, start, end = new_group()
    nodes, link = group.nodes, group.links.new

    def attribute(name):
        node = nodes.new("GeometryNodeInputNamedAttribute")
        node.data_type = "FLOAT_VECTOR"
        node.inputs["Name"].default_value = name
        return node.outputs["Attribute"]

    info = nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = ob
    sample = nodes.new("GeometryNodeSampleUVSurface")
    sample.data_type = "FLOAT_VECTOR"
    link(info.outputs["Geometry"], sample.inputs["Mesh"])
    link(nodes.new("GeometryNodeInputPosition").outputs[0], sample.inputs["Value"])
    link(attribute("Flat"), sample.inputs["UV Map"])
    link(attribute(ids.SURFACE_UV), sample.inputs["Sample UV"])
    geometry = start.outputs[0]
    for name, kind in (("Value", "FLOAT_VECTOR"), ("Is Valid", "FLOAT")):
        store = nodes.new("GeometryNodeStoreNamedAttribute")
        store.data_type, store.domain = kind, "CURVE"
        store.inputs["Name"].default_value = f"found {name}"
        link(geometry, store.inputs["Geometry"])
        link(sample.outputs[name], store.inputs["Value"])
        geometry = store.outputs[0]
    link(geometry, end.inputs[0])
    return group


def evaluated(ob):
    return ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data


def sampled(ob):
    """Returns how far from their roots Sample UV Surface finds strands, and which of them it
    finds.
    """
    hair = add_hair(ob)
    hair.modifiers.new("Nodes", "NODES").node_group = sampling_group(ob)
    found = evaluated(hair)
    roots = scenes.strands(hair)[:, 0]
    distance = np.linalg.norm(attributes.read(found, "found Value") - roots, axis=1)
    return distance, attributes.read(found, "found Is Valid") > 0


@pytest.mark.parametrize("uv_smooth", rules.UV_INTERPOLATIONS)
def test_sample_uv_surface_finds_the_root(sheet, uv_smooth):
    sheet.modifiers[0].uv_smooth = uv_smooth
    distance, valid = sampled(sheet)
    assert valid.mean() > 0.99  # polygons do not reach all of a round border
    assert distance[valid].max() < NEAR


def switch_off(subsurf):
    subsurf.show_viewport = False


def level_0(subsurf):
    subsurf.levels = 0


def simplify(subsurf):
    render = bpy.context.scene.render
    render.use_simplify, render.simplify_subdivision = True, 0


def take_away(subsurf):
    subsurf.id_data.modifiers.remove(subsurf)


def only_the_second(subsurf):
    """Adds a second modifier, which smooths the map by another rule than the first one; that is at
    level 0.
    """
    second = add_subsurf(subsurf.id_data, "PRESERVE_CORNERS")
    second.levels, second.quality, second.uv_smooth = LEVELS, 10, "PRESERVE_CORNERS"
    subsurf.levels, subsurf.uv_smooth = 0, "SMOOTH_ALL"


STATES = (switch_off, level_0, simplify, take_away, only_the_second)


@pytest.mark.parametrize("uv_smooth", ["SMOOTH_ALL", "PRESERVE_BOUNDARIES", "NONE"])
@pytest.mark.parametrize("change", STATES)
def test_sample_uv_surface_finds_the_root_where_nothing_is_subdivided(change, uv_smooth):
    """A flat sheet of 6 x 6 squares is itself the limit surface away from its border. On the map
    the squares are rectangles of different width, so that a smoothed map is far from the linear
    one.
    """
    ob = scenes.flat_grid(6)
    subsurf = add_subsurf(ob, "PRESERVE_CORNERS")
    subsurf.levels, subsurf.quality, subsurf.uv_smooth = LEVELS, 10, uv_smooth
    columns = np.array([0, 0.05, 0.3, 0.4, 0.65, 0.7, 1])
    scenes.add_uv_map(ob, lambda p: np.stack([columns[p[:, 0].astype(int)], p[:, 1] / 8], axis=1))
    change(subsurf)
    distance, valid = sampled(ob)
    face = np.repeat(np.arange(36), 16)
    inner = (np.abs(face % 6 - 2.5) < 2) & (np.abs(face // 6 - 2.5) < 2)
    assert valid[inner].all()
    assert distance[inner].max() < NEAR


def test_blenders_attach_hair_stores_the_same(sheet):
    """The node group from Blender's assets finds the UV of a root by itself, on the evaluated
    mesh, and stores it under the same name."""
    sheet.modifiers[0].uv_smooth = "SMOOTH_ALL"
    hair = add_hair(sheet)
    ours = attributes.read(hair.data, ids.SURFACE_UV)
    (library,) = Path(bpy.utils.resource_path("LOCAL")).glob(ASSETS)
    with bpy.data.libraries.load(str(library)) as (_, wanted):
        wanted.node_groups = ["Attach Hair Curves to Surface"]
    group = wanted.node_groups[0]
    attach = hair.modifiers.new("Attach", "NODES")
    attach.node_group = group
    # Blender 5.2 has another name for the object, and keeps inputs elsewhere.
    (surface,) = (i.name for i in group.interface.items_tree if _is_input(i, "NodeSocketObject"))
    groups.set_input(attach, surface, sheet)
    (uv_map,) = (
        i.identifier
        for i in group.interface.items_tree
        if _is_input(i, "NodeSocketVector") and i.name == "Surface UV Map"
    )
    if bpy.app.version < (5, 2):
        attach[f"{uv_map}_use_attribute"], attach[f"{uv_map}_attribute_name"] = True, "Flat"
    else:
        given = getattr(attach.properties.inputs, uv_map)
        given.type, given.attribute_name = "ATTRIBUTE", "Flat"
    found = evaluated(hair)
    assert np.abs(
        attributes.read(found, "position") - scenes.strands(hair).reshape(-1, 3)
    ).max() < (0.2)
    theirs = attributes.read(found, ids.SURFACE_UV)[:, :2]
    assert np.abs(theirs - ours).max() < NEAR


def _is_input(item, socket_type):
    is_input = item.item_type == "SOCKET" and item.in_out == "INPUT"
    return is_input and item.socket_type == socket_type


def looked_up(mesh, uv):
    """Returns the places on the mesh's triangles that have these UVs, and whether there are any."""
    mesh.calc_loop_triangles()
    corners = np.array([triangle.loops for triangle in mesh.loop_triangles])
    corner_vertex = attributes.read(mesh, ids.CORNER_VERTEX)
    places = attributes.read(mesh, "position").astype(float)[corner_vertex[corners]]
    a, b, c = attributes.read(mesh, "Flat").astype(float)[corners].transpose(1, 2, 0)
    x = uv.astype(float).T[:, :, None]
    whole = cross(b - a, c - a)
    weights = np.stack(
        [cross((c - b)[:, None], x - b[:, None]), cross((a - c)[:, None], x - c[:, None])], axis=2
    )
    weights /= whole[:, None]
    weights = np.concatenate([weights, 1 - weights.sum(axis=2, keepdims=True)], axis=2)
    inside = weights.min(axis=2)
    best = inside.argmax(axis=1)
    chosen = weights[np.arange(len(uv)), best]
    return np.einsum("ni,nij->nj", chosen, places[best]), inside.max(axis=1) > 1e-6


def cross(p, q):
    return p[0] * q[1] - p[1] * q[0]


def test_snapping_looks_on_the_bare_mesh(sheet):
    """Blender's Snap to Deformed Surface ignores modifiers, and so ignores that they smooth the UV
    map.
    """
    sheet.modifiers[0].uv_smooth = "SMOOTH_ALL"
    hair = add_hair(sheet)
    stored = attributes.read(hair.data, ids.SURFACE_UV)
    place, there = looked_up(sheet.data, stored)
    assert there.mean() > 0.8
    assert bpy.ops.curves.snap_curves_to_surface(attach_mode="DEFORM") == {"FINISHED"}
    snapped = scenes.strands(hair)[:, 0]
    np.testing.assert_allclose(snapped[there], place[there], atol=1e-5)
