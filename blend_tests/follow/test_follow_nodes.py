# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points that follow a deforming surface by Geometry Nodes."""

import bmesh
import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming, follow
from limit_surface import ids
from limit_surface.reading import attributes


def test_instances_turn_with_their_points():
    thorn = scenes.add_mesh("Thorn", [(0, 0, 0), (0.1, 0, 0), (0, 0, 1)], [(0, 1, 2)])
    ob = deforming("cross")
    points = scenes.add_points(ob, per_side=2, instance=thorn.name, follow="NODES")
    bpy.context.scene.frame_set(30)
    now = follow_truth.on_surface(ob, points.data)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    to_points = np.linalg.inv(np.array(points.matrix_world))
    found = np.array(
        [
            to_points @ np.array(instance.matrix_world)
            for instance in depsgraph.object_instances
            if instance.is_instance and instance.parent.original == points
        ]
    )
    assert len(found) == len(now.position)
    assert np.abs(found[:, :3, 3] - now.position).max() < 1e-5
    assert np.abs(found[:, :3, :3] - now.frame).max() < follow_truth.FRAME_BOUND


@pytest.mark.parametrize("target", ["VIEWPORT", "RENDER"])
def test_hair_on_displayed_polygons_keeps_its_distance(target):
    ob = deforming("monkey")
    hair = scenes.add_hair(ob, per_side=1, target=target, follow="NODES")
    diagonal = follow_truth.diagonal(ob)
    exact = follow_truth.on_surface(ob, hair.data)
    offset = np.linalg.norm(scenes.strands(hair)[:, 0] - exact.position, axis=1)
    assert offset.max() > 1e-4 * diagonal
    moved = np.abs(follow_truth.shown_strands(hair) - scenes.strands(hair)).max()
    assert moved < follow_truth.POSITION_BOUND * diagonal
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)
    later = follow_truth.on_surface(ob, hair.data)
    distance = np.linalg.norm(follow_truth.shown_strands(hair)[:, 0] - later.position, axis=1)
    np.testing.assert_allclose(distance, offset, atol=follow_truth.POSITION_BOUND * diagonal)


@pytest.mark.parametrize(
    ("deforms", "follow"), [(False, "AUTO"), (True, "AUTO"), (False, "NODES"), (True, "NONE")]
)
def test_new_things_follow_where_they_are_told_to(deforms, follow):
    ob = deforming("cross") if deforms else scenes.cross()
    for thing in (scenes.add_hair(ob, follow=follow), scenes.add_points(ob, follow=follow)):
        follows = follow == "NODES" or (deforms and follow == "AUTO")
        assert bool(thing.modifiers) == follows
        assert (ids.TILE in thing.data.attributes) == follows


DEFORMERS = {
    "shape key": lambda ob: ob.shape_key_add(name="Basis"),
    "modifier": lambda ob: ob.modifiers.new("Cast", "CAST"),
    "animated mesh": lambda ob: ob.data.vertices[0].keyframe_insert("co"),
}


@pytest.mark.parametrize("deformer", [*DEFORMERS, "armature"])
def test_automatic_following_sees(deformer):
    ob = scenes.cross()
    scenes.add_subsurf(ob)
    if deformer == "armature":
        armature = bpy.data.objects.new("Bones", bpy.data.armatures.new("Bones"))
        bpy.context.collection.objects.link(armature)
        ob.parent, ob.parent_type = armature, "ARMATURE"
    else:
        DEFORMERS[deformer](ob)
        for modifier in ob.modifiers:
            if modifier.type == "CAST":
                ob.modifiers.move(ob.modifiers.find(modifier.name), 0)
    assert scenes.add_hair(ob).modifiers


def test_a_modifier_behind_the_subdivision_deforms_nothing():
    ob = scenes.cross()
    scenes.add_subsurf(ob)
    ob.modifiers.new("Cast", "CAST")
    assert not scenes.add_hair(ob).modifiers


def test_one_surface_has_one_pair_of_tables():
    ob = deforming("cross")
    hair, points = scenes.add_hair(ob, follow="NONE"), scenes.add_points(ob, follow="NONE")
    more = scenes.add_hair(ob, seed=5, distribution="UNIFORM", count=40, follow="NONE")
    follow(hair, points, more)
    names = {o.name for o in bpy.data.objects} - {o.name for o in (ob, hair, points, more)}
    assert names == {f"{table} of Cross" for table in (ids.POINTS_TABLE, ids.TILES_TABLE)}
    assert [m.name for m in ob.modifiers] == ["Wave", ids.CAPTURE_GROUP, "Subdivision"]
    bpy.context.scene.frame_set(25)
    check_hair(ob, hair)
    check_hair(ob, more)


def test_combing_goes_on_working():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    bpy.context.scene.frame_set(30)
    combed = scenes.strands(hair)
    combed[:, 1:] += [0.1, 0.2, -0.05]
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", combed)
    hair.data.update_tag()
    check_hair(ob, hair)


def test_strands_that_are_added_later_stay():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, points=4, follow="NONE")
    follow(hair)
    count = len(hair.data.curves)
    hair.data.add_curves([4, 4])
    added = np.arange(24, dtype=np.float32).reshape(2, 4, 3)
    positions = np.concatenate([scenes.strands(hair)[:count], added])
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)
    bpy.context.scene.frame_set(30)
    np.testing.assert_allclose(follow_truth.shown_strands(hair)[count:], added, atol=1e-5)
    assert np.abs(follow_truth.shown_strands(hair) - positions)[:count].max() > 0.1


def swap_first_vertices(mesh: bpy.types.Mesh) -> None:
    edited = bmesh.new()
    edited.from_mesh(mesh)
    edited.verts.sort(key=lambda vertex: {0: 1, 1: 0}.get(vertex.index, vertex.index))
    edited.to_mesh(mesh)
    edited.free()


@pytest.mark.parametrize("change", ["count", "order"])
def test_a_changed_control_mesh_leaves_things_at_rest(change):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    bpy.context.scene.frame_set(30)
    assert np.abs(follow_truth.shown_strands(hair) - scenes.strands(hair)).max() > 0.1
    if change == "count":
        modifier = ob.modifiers.new("Mirror", "MIRROR")
        ob.modifiers.move(ob.modifiers.find(modifier.name), 0)
    else:
        swap_first_vertices(ob.data)
    bpy.context.view_layer.update()
    np.testing.assert_allclose(follow_truth.shown_strands(hair), scenes.strands(hair), atol=1e-6)


def test_it_is_bound_again_after_a_reload(tmp_path):
    ob = deforming("monkey")
    follow(scenes.add_hair(ob, per_side=1, follow="NONE"))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    ob, hair = bpy.data.objects["Suzanne"], bpy.data.objects[ids.HAIR_OBJECT]
    bpy.context.scene.frame_set(22)
    check_hair(ob, hair)
    scenes.activate(ob)
    more = scenes.add_points(ob, per_side=1, follow="NONE")
    follow(more)
    assert len([o for o in bpy.data.objects if o.name.startswith(ids.TILES_TABLE)]) == 1


def test_a_proxy_stands_for_the_surface_in_the_viewport(tmp_path):
    ob = deforming("monkey")
    hair = scenes.add_hair(ob, per_side=1, follow="NONE")
    names = {o.name for o in bpy.context.scene.objects}
    scenes.activate(hair)
    bpy.ops.object.limit_follow(use_proxy=True)
    assert {o.name for o in bpy.context.scene.objects} - names == {
        f"{table} of Suzanne" for table in (ids.POINTS_TABLE, ids.TILES_TABLE)
    }
    proxy = bpy.data.objects[f"{ids.PROXY_OBJECT} of Suzanne"]
    assert proxy.data == ob.data
    assert [m.type for m in proxy.modifiers] == ["WAVE", "NODES"]
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)
    # what is added later keeps the proxy, and a file carries it
    scenes.add_points(ob, per_side=1, follow="NODES")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    assert [o.name for o in bpy.data.objects if ids.PROXY_OBJECT in o.name] == [
        f"{ids.PROXY_OBJECT} of Suzanne"
    ]
    ob, hair = bpy.data.objects["Suzanne"], bpy.data.objects[ids.HAIR_OBJECT]
    bpy.context.scene.frame_set(17)
    check_hair(ob, hair)
    scenes.activate(hair)
    bpy.ops.object.limit_follow(use_proxy=False)
    assert not [o.name for o in bpy.data.objects if ids.PROXY_OBJECT in o.name]
    bpy.context.scene.frame_set(3)
    check_hair(ob, hair)


def test_an_object_without_locations_is_refused():
    ob = deforming("cross")
    scenes.activate(ob)
    with pytest.raises(RuntimeError, match="Select hair or points that stand on a limit surface"):
        bpy.ops.object.limit_follow()
