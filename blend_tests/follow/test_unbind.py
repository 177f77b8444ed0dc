# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that follow a surface no longer."""

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming, follow
from limit_surface import ids
from limit_surface.reading import attributes

KEPT = (ids.POINTS_TABLE, ids.TILES_TABLE, ids.PROXY_OBJECT)


def unbind(*things: bpy.types.Object, shape: str = "SHOWN") -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)
        scenes.activate(thing)
    assert bpy.ops.object.limit_unbind(shape=shape) == {"FINISHED"}


def traces() -> set[str]:
    """Returns what following leaves in a file: objects, modifiers, attributes, properties."""
    found = {name for name in KEPT for ob in bpy.data.objects if ob.name.startswith(f"{name} of")}
    for ob in bpy.data.objects:
        found |= {m.name for m in ob.modifiers if m.type == "NODES"}
        if hasattr(ob.data, "attributes"):
            found |= {ids.TILE, ids.TILE_UV, ids.SIGNATURE} & {*ob.data.attributes.keys()}
            found |= {ids.SIGNATURE} & {*ob.data.keys()}
    return found


def test_hair_keeps_the_shape_that_is_shown():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, tilt=(0.4, 0.2), follow="NODES")
    bpy.context.scene.frame_set(17, subframe=0.25)
    shown = follow_truth.shown_strands(hair)
    unbind(hair)
    np.testing.assert_array_equal(scenes.strands(hair), shown)
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), shown)
    assert traces() == set()
    # what is stored about its places is that of this frame
    now = follow_truth.on_surface(ob, hair.data)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    assert np.abs(follow_truth.rest(hair.data).position - now.position).max() < bound
    follow(hair)
    np.testing.assert_allclose(follow_truth.shown_strands(hair), shown, atol=4e-6)
    bpy.context.scene.frame_set(28)
    check_hair(ob, hair)


def test_points_keep_their_frames():
    ob = deforming("monkey")
    points = scenes.add_points(ob, per_side=1, follow="NODES")
    bpy.context.scene.frame_set(25)
    names = (ids.POSITION, ids.NORMAL, ids.TANGENT, ids.ROTATION)
    shown = [follow_truth.shown(points, name) for name in names]
    unbind(points)
    for name, values in zip(names, shown, strict=True):
        np.testing.assert_array_equal(attributes.read(points.data, name), values)


def test_hair_goes_back_to_rest():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NODES")
    rest, stored = scenes.strands(hair), attributes.read(hair.data, ids.REST_ROOT)
    bpy.context.scene.frame_set(30)
    unbind(hair, shape="REST")
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), rest)
    np.testing.assert_array_equal(attributes.read(hair.data, ids.REST_ROOT), stored)
    assert traces() == set()


def test_what_comes_after_in_the_stack_is_not_applied():
    ob = deforming("cross")
    ball = bpy.data.objects.new("Ball", bpy.data.meshes.new("Ball"))
    bpy.context.collection.objects.link(ball)
    points = scenes.add_points(ob, instance=ball.name, follow="NODES")
    bpy.context.scene.frame_set(30)
    now = follow_truth.on_surface(ob, points.data).position
    unbind(points)
    assert [m.name for m in points.modifiers] == [ids.INSTANCES_GROUP]
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    assert np.abs(attributes.read(points.data, ids.POSITION) - now).max() < bound


def test_tables_are_removed_with_the_last_follower():
    ob = deforming("cross")
    hair, points = scenes.add_hair(ob, follow="NODES"), scenes.add_points(ob, follow="NODES")
    before = scenes.file_contents()["meshes"]
    bpy.context.scene.frame_set(9)
    unbind(hair)
    assert {ids.POINTS_TABLE, ids.TILES_TABLE, ids.CAPTURE_GROUP} <= traces()
    check_points = follow_truth.on_surface(ob, points.data).position
    error = np.abs(follow_truth.shown(points, ids.POSITION) - check_points).max()
    assert error < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    unbind(points)
    assert traces() == set()
    assert len(scenes.file_contents()["meshes"]) == len(before) - 2


def test_tables_that_a_users_own_nodes_read_are_kept():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NODES")
    group = bpy.data.node_groups.new("Mine", "GeometryNodeTree")
    info = group.nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = bpy.data.objects[f"{ids.TILES_TABLE} of Cross"]
    unbind(hair)
    assert traces() == {ids.POINTS_TABLE, ids.TILES_TABLE, ids.TILES_GROUP, ids.CAPTURE_GROUP}


def test_the_active_mesh_stands_for_all_that_follows_it():
    ob = deforming("cross")
    for _ in range(2):
        scenes.add_hair(ob, follow="NODES")
    unbind(ob)
    assert traces() == set()


def test_undo_gives_everything_back():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.context.scene.frame_set(21)
    before, shown = traces(), follow_truth.shown_strands(hair)
    bpy.ops.ed.undo_push(message="before")
    unbind(hair)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert traces() == before
    ob, hair = bpy.data.objects["Cross"], bpy.data.objects[ids.HAIR_OBJECT]
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), shown)
    bpy.context.scene.frame_set(12)
    check_hair(ob, hair)
    bpy.ops.ed.redo()
    assert traces() == set()


def test_hair_at_rest_on_a_changed_surface_stays_there():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NODES")
    rest, stored = scenes.strands(hair), attributes.read(hair.data, ids.REST_ROOT)
    mirror = ob.modifiers.new("Mirror", "MIRROR")
    ob.modifiers.move(ob.modifiers.find(mirror.name), 0)
    bpy.context.scene.frame_set(30)
    unbind(hair)
    np.testing.assert_array_equal(scenes.strands(hair), rest)
    np.testing.assert_array_equal(attributes.read(hair.data, ids.REST_ROOT), stored)
    assert traces() == set()


def test_a_proxy_is_removed_with_the_tables():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    scenes.activate(hair)
    bpy.ops.object.limit_follow(use_proxy=True)
    assert ids.PROXY_OBJECT in traces()
    unbind(hair)
    assert traces() == set()


def test_hair_of_a_removed_surface_is_unbound():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NODES")
    rest = scenes.strands(hair)
    bpy.data.objects.remove(ob)
    unbind(hair)
    np.testing.assert_array_equal(scenes.strands(hair), rest)
    assert traces() == set()


def refused(match: str, *things: bpy.types.Object, **properties: object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)
        scenes.activate(thing)
    before = scenes.file_contents(), traces()
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_unbind(**properties)
    assert (scenes.file_contents(), traces()) == before


def test_refusals():
    ob = deforming("cross")
    refused("Select what follows a limit surface", ob)
    hair = scenes.add_hair(ob, follow="NODES")
    twin = hair.copy()
    bpy.context.collection.objects.link(twin)
    refused(f"shares its data with {twin.name}", hair)
    unbind(hair, shape="REST")
    check_hair(ob, twin)
    points = scenes.add_points(ob, follow="NODES")
    points.shape_key_add(name="Basis")
    refused("has shape keys", points)


def test_only_in_object_mode():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NODES")
    scenes.activate(hair)
    bpy.ops.object.mode_set(mode="EDIT")
    refused_message = "Only available in Object Mode"
    with pytest.raises(RuntimeError, match=refused_message):
        bpy.ops.object.limit_unbind()


@pytest.mark.parametrize("mode", ["NODES", "LIVE"])
def test_copies_of_a_surface_lose_limit_capture(mode):
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, follow=mode)
    bpy.ops.object.select_all(action="DESELECT")
    copies = [ob.copy() for _ in range(2)]
    for copy in copies:
        bpy.context.collection.objects.link(copy)
        copy.select_set(True)
        assert ids.CAPTURE_GROUP in copy.modifiers
    scenes.activate(copies[0])
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    for copy in copies:
        assert [modifier.type for modifier in copy.modifiers] == ["SUBSURF"]
    assert not bpy.ops.object.limit_unbind.poll()
    assert ids.CAPTURE_GROUP in ob.modifiers
    assert hair.modifiers


def test_the_capture_of_an_overridden_surface_stays(tmp_path):
    ob = deforming("cross")
    scenes.add_hair(ob, follow="LIVE")
    (ob,) = scenes.overridden(tmp_path, ob)
    scenes.activate(ob)
    ob.select_set(True)
    assert not bpy.ops.object.limit_unbind.poll()
    assert ids.CAPTURE_GROUP in ob.modifiers


def test_tables_and_capture_of_deleted_hair_are_removed():
    ob = deforming("cross")
    for mode in ("NODES", "LIVE"):
        bpy.data.objects.remove(scenes.add_hair(ob, follow=mode))
        assert ids.CAPTURE_GROUP in ob.modifiers
        unbind(ob)
        assert traces() == set()
