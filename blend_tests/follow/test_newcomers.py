# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points from elsewhere that are bound to a surface."""

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming
from limit_surface import ids
from limit_surface.reading import attributes
from mathutils import Matrix


def groom(positions: np.ndarray, surface: bpy.types.Object | None = None) -> bpy.types.Object:
    """Adds hair as an importer does: strands (n, k, 3), which store nothing of a surface."""
    data = bpy.data.hair_curves.new("Groom")
    if len(positions):  # Blender crashes when no curves are added
        data.add_curves([positions.shape[1]] * len(positions))
        attributes.write(data, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)
    data.surface = surface
    ob = bpy.data.objects.new("Groom", data)
    bpy.context.collection.objects.link(ob)
    return ob


def strands_near(ob: bpy.types.Object, count: int = 40) -> np.ndarray:
    """Returns strands that begin near the surface, in the world."""
    rng = np.random.default_rng(8)
    surface = scenes.surface_without_addon(ob)
    at = surface.scatter_uniform(count, 3)
    roots = scenes.transformed(ob.matrix_world, surface.evaluate(at.face, at.uv).position)
    return roots[:, None] + np.cumsum(rng.normal(0, 0.05, (count, 4, 3)), axis=1)


def bind(surface: bpy.types.Object | None, *things: bpy.types.Object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)
    scenes.activate(surface or things[0])
    assert bpy.ops.object.limit_follow() == {"FINISHED"}


@pytest.mark.parametrize("own_surface", [True, False])
def test_an_imported_groom_is_bound_at_its_closest_points(own_surface):
    ob = deforming("grid with holes")
    bpy.context.scene.frame_set(5)
    strands = strands_near(ob)
    hair = groom(strands, ob if own_surface else None)
    before = scenes.strands(hair)
    bind(None if own_surface else ob, hair)
    assert hair.data.surface == ob
    np.testing.assert_array_equal(scenes.strands(hair), before)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    assert np.abs(follow_truth.shown_strands(hair) - before).max() < bound
    # the roots at rest are the points of the surface in the world that are closest to the strands
    surface = scenes.surface_without_addon(ob)
    cage = scenes.transformed(ob.matrix_world, surface.positions)
    surface.set_positions(cage)
    hits = surface.closest(before[:, 0].astype(np.float64))
    np.testing.assert_allclose(follow_truth.rest(hair.data).position, hits.position, atol=1e-5)
    for frame in (14, 30):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)


def test_hair_of_another_transform_is_bound_in_its_own_space():
    ob = deforming("cross")
    hair = groom(strands_near(ob) * [2, 1, -1])
    hair.matrix_world = Matrix.Diagonal((0.5, 1, -1, 1))
    before = scenes.strands(hair)
    bind(ob, hair)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    assert np.abs(follow_truth.shown_strands(hair) - before).max() < 2 * bound
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)


def test_the_vertices_of_a_mesh_are_bound():
    ob = deforming("monkey")
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1.4)
    ball = bpy.context.active_object
    ball.parent = scenes.add_mesh("Parent", [(0, 0, 0)], [])
    before = attributes.read(ball.data, ids.POSITION)
    bind(ob, ball)
    bound = 3 * follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    assert np.abs(follow_truth.shown(ball, ids.POSITION) - before).max() < bound
    bpy.context.scene.frame_set(30)
    relation = np.linalg.inv(np.array(ball.matrix_world)) @ np.array(ob.matrix_world)
    now = follow_truth.on_surface(ob, ball.data, relation)
    expected = follow_truth.moved(before[:, None], ball.data, now)[:, 0]
    assert np.abs(follow_truth.shown(ball, ids.POSITION) - expected).max() < bound


def test_strands_that_were_added_later_are_bound_where_they_are():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, points=4, follow="NODES")
    old = len(hair.data.curves)
    bpy.context.scene.frame_set(30)
    shown = follow_truth.shown_strands(hair)
    hair.data.add_curves([4, 4])
    added = np.array([[0.2, 0.1, 0.3], [0.5, 0.1, 0.2]])[:, None] + np.zeros((2, 4, 3))
    added[:, :, 2] += [0, 0.1, 0.2, 0.3]
    positions = np.concatenate([scenes.strands(hair)[:old], added])
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)
    bind(None, hair)
    everything = np.concatenate([shown, added])
    np.testing.assert_allclose(follow_truth.shown_strands(hair), everything, atol=1e-5)
    assert np.all(attributes.read(hair.data, ids.TILE) > 0)
    bpy.context.scene.frame_set(3)
    check_hair(ob, hair)


def test_blenders_own_fur_is_moved_once():
    ob = deforming("cross")
    hair = groom(strands_near(ob), ob)
    group = bpy.data.node_groups.new("Surface Deform", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes = [
        group.nodes.new(name)
        for name in ("NodeGroupInput", "GeometryNodeDeformCurvesOnSurface", "NodeGroupOutput")
    ]
    for here, there in zip(nodes, nodes[1:], strict=False):
        group.links.new(here.outputs[0], there.inputs[0])
    modifier = hair.modifiers.new("Surface Deform", "NODES")
    modifier.node_group = group
    bind(None, hair)
    assert not modifier.show_viewport
    assert not modifier.show_render
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)


def refused(match: str, surface: bpy.types.Object, *things: bpy.types.Object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)
    scenes.activate(surface)
    before = scenes.file_contents()
    modifiers = [[m.name for m in ob.modifiers] for ob in bpy.data.objects]
    stored = [sorted(thing.data.attributes.keys()) for thing in things]
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_follow()
    assert scenes.file_contents() == before
    assert [[m.name for m in ob.modifiers] for ob in bpy.data.objects] == modifiers
    assert [sorted(thing.data.attributes.keys()) for thing in things] == stored


def test_bad_surfaces_are_refused():
    ob = deforming("cross")
    hair = groom(strands_near(ob))
    refused("has no surface: select the mesh", hair, hair)
    edges = scenes.add_mesh("Edges", [(0, 0, 0), (1, 0, 0)], [], [(0, 1)])
    refused("Edges has no faces", edges, hair)
    multires = scenes.cross()
    multires.modifiers.new("Multires", "MULTIRES")
    refused("Multiresolution .* is not supported", multires, hair)
    elsewhere = scenes.cross()
    bpy.context.collection.objects.unlink(elsewhere)
    bpy.data.scenes.new("Other").collection.objects.link(elsewhere)
    hair.data.surface = elsewhere
    refused("is not in the scene Scene", hair, hair)


def test_a_linked_surface_is_refused(tmp_path):
    ob = deforming("cross")
    strands = strands_near(ob)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(tmp_path / "a.blend"), link=True) as (_there, here):
        here.objects = ["Cross"]
    bpy.context.collection.objects.link(here.objects[0])
    hair = groom(strands)
    refused("linked from another file: make a library override", here.objects[0], hair)


def test_bad_things_are_refused():
    ob, other = deforming("cross"), deforming("grid with holes")
    refused(f"belongs to {other.name}, not to {ob.name}", ob, groom(strands_near(ob), other))
    refused("has no points", ob, groom(np.empty((0, 4, 3))))
    refused("Select hair or points", ob, ob)
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    bpy.context.collection.objects.link(lamp)
    refused("Select hair or points", lamp)
    hair = groom(strands_near(ob))
    hair.data.attributes.new(ids.FACE, "FLOAT", "POINT")
    refused("has an attribute limit_face of another type or domain", ob, hair)
    parent = scenes.cross()
    ob.parent = parent
    refused("cannot follow itself or an object that is parented to it", ob, parent)


def test_a_surface_in_edit_mode_is_refused():
    ob = deforming("cross")
    hair = groom(strands_near(ob), ob)
    hair.select_set(True)
    scenes.activate(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Only available in Object Mode"):
        bpy.ops.object.limit_follow()
    bpy.context.view_layer.objects.active = hair
    assert ob.mode == "EDIT"
    with pytest.raises(RuntimeError, match=f"{ob.name} is in Edit Mode"):
        bpy.ops.object.limit_follow()
    assert not hair.modifiers


def test_a_surface_without_a_limit_is_refused():
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    bad = scenes.add_mesh("Bad", corners, [(0, 1, 2, 3)])
    # a face that uses a vertex twice, which from_pydata does not refuse
    bad.data.loops[2].vertex_index = 0
    refused("No face of Bad has a limit surface", bad, groom(np.zeros((3, 4, 3))))
