# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that cease to follow live, and strands that begin to."""

import bmesh
import bpy
import live_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from live_scenes import check_hair, deforming, follow


@pytest.fixture
def hair() -> bpy.types.Object:
    made = scenes.add_hair(deforming("cross"), points=4, follow="NONE")
    follow(made)
    bpy.context.scene.frame_set(20)
    return made


def is_bare(hair: bpy.types.Object) -> bool:
    names = set(hair.data.attributes.keys())
    left = [name for name in names if name.startswith((ids.LIVE_REST, ids.LIVE_FINGERPRINT))]
    return not (left or hair.modifiers or ids.LIVE_WRITTEN in hair.data)


def test_hair_stays_where_it_is_shown(hair):
    shown = scenes.strands(hair).copy()
    assert bpy.ops.object.limit_unbind(shape="SHOWN") == {"FINISHED"}
    assert is_bare(hair)
    np.testing.assert_array_equal(scenes.strands(hair), shown)
    assert ids.CAPTURE_GROUP not in bpy.data.objects["Cross"].modifiers
    bpy.context.scene.frame_set(3)
    np.testing.assert_array_equal(scenes.strands(hair), shown)
    bpy.context.scene.frame_set(20)
    follow(hair)  # nothing moves when it is bound again
    np.testing.assert_allclose(scenes.strands(hair), shown, atol=1e-5)
    bpy.context.scene.frame_set(9)
    check_hair(bpy.data.objects["Cross"], hair)


def test_hair_goes_back_to_rest(hair):
    rest = live_scenes.rest(hair).copy()
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    assert is_bare(hair)
    np.testing.assert_array_equal(scenes.strands(hair), rest)


def test_the_capture_stays_for_those_that_follow_still(hair):
    ob = bpy.data.objects["Cross"]
    by_nodes = scenes.add_hair(ob, follow="NONE", seed=3)
    follow(by_nodes, mode="NODES")
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert ids.CAPTURE_GROUP in ob.modifiers
    bpy.context.scene.frame_set(4)
    check_hair(ob, hair)


def test_strands_that_were_added_are_bound_when_it_is_asked_for(hair):
    ob = bpy.data.objects["Cross"]
    hair.data.add_curves([4, 4])
    points = scenes.strands(hair).copy()
    points[-2:] = points[:2] + [0.01, 0.02, 0.03]
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", points)
    hair.data.update_tag()
    follow(hair)
    np.testing.assert_allclose(scenes.strands(hair), points, atol=1e-5)
    bpy.context.scene.frame_set(2)
    assert np.abs(scenes.strands(hair)[-2:] - points[-2:]).max() > 0.01
    check_hair(ob, hair)


def test_hair_from_elsewhere_follows():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE", points=4)
    for name in (ids.FACE, ids.UV, ids.REST_ROOT, ids.REST_ROTATION):
        hair.data.attributes.remove(hair.data.attributes[name])
    before = scenes.strands(hair).copy()
    follow(hair)
    np.testing.assert_allclose(scenes.strands(hair), before, atol=1e-5)
    bpy.context.scene.frame_set(25)
    check_hair(ob, hair)
    assert np.abs(scenes.strands(hair) - before).max() > 0.05


@pytest.mark.parametrize("target", ["LIMIT", "VIEWPORT"])
def test_new_hair_and_points_follow_at_once(target):
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="LIVE", target=target)
    points = scenes.add_points(ob, follow="LIVE")
    bpy.context.scene.frame_set(25)
    check_hair(ob, hair)
    now = live_scenes.follow_truth.on_surface(ob, points.data)
    shown = live_scenes.follow_truth.shown(points, ids.POSITION)
    assert np.abs(shown - now.position).max() < 1e-5


def test_a_surface_in_another_scene_is_refused_before_anything_is_made():
    ob = deforming("cross")
    other = bpy.data.scenes.new("Other")
    other.collection.objects.link(ob)
    bpy.context.scene.collection.objects.unlink(ob)
    objects = len(bpy.data.objects)
    with pytest.raises(RuntimeError):
        bpy.ops.object.limit_hair_add(follow="LIVE")
    assert len(bpy.data.objects) == objects


def without_faces(ob: bpy.types.Object) -> None:
    ob.shape_key_clear()
    ob.data.clear_geometry()


def with_fewer_faces(ob: bpy.types.Object) -> None:
    ob.shape_key_clear()
    edited = bmesh.new()
    edited.from_mesh(ob.data)
    bmesh.ops.delete(edited, geom=list(edited.faces)[2:4], context="FACES_ONLY")
    edited.to_mesh(ob.data)
    edited.free()


def deleted(ob: bpy.types.Object) -> None:
    bpy.data.objects.remove(ob)


LOSSES = [without_faces, with_fewer_faces, deleted]


@pytest.mark.parametrize("lose", LOSSES)
def test_hair_stays_where_it_is_shown_when_its_faces_are_gone(hair, lose):
    world = hair.matrix_world.copy()
    lose(bpy.data.objects["Cross"])
    hair.matrix_world = world
    bpy.context.scene.frame_set(7)
    shown = scenes.strands(hair).copy()
    assert bpy.ops.object.limit_unbind(shape="SHOWN") == {"FINISHED"}
    assert is_bare(hair)
    np.testing.assert_array_equal(scenes.strands(hair), shown)
    assert (attributes.read(hair.data, ids.FACE) == -1).all()
    if lose is with_fewer_faces:
        follow(hair)  # at the closest points, without moving
        np.testing.assert_allclose(scenes.strands(hair), shown, atol=1e-5)


@pytest.mark.parametrize("lose", LOSSES)
def test_hair_goes_back_to_rest_when_its_faces_are_gone(hair, lose):
    rest = live_scenes.rest(hair).copy()
    lose(bpy.data.objects["Cross"])
    bpy.context.scene.frame_set(7)
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    assert is_bare(hair)
    np.testing.assert_array_equal(scenes.strands(hair), rest)


def test_strands_lose_their_places_whose_faces_are_missing_in_a_frame():
    ob = deforming("cross")
    build = ob.modifiers.new("Build", "BUILD")
    build.frame_start, build.frame_duration = 1, 20
    ob.modifiers.move(ob.modifiers.find(build.name), 0)
    bpy.context.scene.frame_set(30)
    hair = scenes.add_hair(ob, follow="LIVE")
    bpy.context.scene.frame_set(12)
    shown, faces = scenes.strands(hair).copy(), attributes.read(hair.data, ids.FACE)
    assert bpy.ops.object.limit_unbind(shape="SHOWN") == {"FINISHED"}
    np.testing.assert_array_equal(scenes.strands(hair), shown)
    left = attributes.read(hair.data, ids.FACE)
    assert 0 < (left == -1).sum() < len(left)
    np.testing.assert_array_equal(left[left != -1], faces[left != -1])
