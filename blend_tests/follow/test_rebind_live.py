# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that follow live and are bound again after their surface has changed."""

import bpy
import follow_truth
import live_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import live_kept
from limit_surface.placing.followers import live_modifier_of, modifier_of
from limit_surface.reading import attributes
from live_scenes import FRAMES, check_hair, deforming
from test_rebind import rebind, refused, remove_faces, renumber_faces, selected


def with_map() -> bpy.types.Object:
    ob = deforming("grid with holes")
    scenes.add_uv_map(ob, lambda p: p[:, :2] / 5)
    return ob


def live_hair(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    hair = scenes.add_hair(ob, **{"tilt": (0.4, 0.2), "follow": "LIVE"} | properties)
    assert live_modifier_of(hair)
    return hair


@pytest.mark.parametrize("by", ["hair", "surface"])
@pytest.mark.parametrize("method", ["CLOSEST", "UV"])
def test_other_numbers_of_faces_move_nothing(method, by, capfd):
    ob = with_map()
    hair = live_hair(ob)
    rest, faces = live_scenes.rest(hair).copy(), attributes.read(hair.data, ids.FACE)
    renumber_faces(ob.data)
    rebind(hair if by == "hair" else ob, method=method)
    assert live_modifier_of(hair)
    assert modifier_of(hair) is None
    assert not [o.name for o in bpy.data.objects if o.name.startswith(ids.TILES_TABLE)]
    assert np.mean(attributes.read(hair.data, ids.FACE) != faces) > 0.8
    np.testing.assert_allclose(live_scenes.rest(hair), rest, atol=1e-5)
    assert (
        f"{len(faces)} strands and points on Holes are bound again. At rest they moved"
        in capfd.readouterr().out
    )
    check_hair(ob, hair)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        check_hair(ob, hair)


def test_points_keep_their_orientation():
    ob = deforming("grid with holes")
    points = scenes.add_points(ob, follow="LIVE")
    names = (ids.POSITION, ids.NORMAL, ids.TANGENT, ids.ROTATION)
    before = [attributes.read(points.data, name) for name in names]
    renumber_faces(ob.data)
    bpy.context.scene.frame_set(30)
    bpy.context.scene.frame_set(1)
    rebind(points)
    for name, values in zip(names, before, strict=True):
        np.testing.assert_allclose(attributes.read(points.data, name), values, atol=2e-5)
    bpy.context.scene.frame_set(30)
    now = follow_truth.on_surface(ob, points.data).position
    error = np.abs(follow_truth.shown(points, ids.POSITION) - now).max()
    assert error < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)


def test_what_was_combed_just_before_is_kept():
    ob = deforming("grid with holes")
    hair = live_hair(ob)
    renumber_faces(ob.data)
    bpy.context.view_layer.update()
    rebind(hair)
    combed = scenes.strands(hair).copy()
    combed[:20, 1:] += [0.1, 0.2, -0.05]
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", combed)
    hair.data.update_tag()
    rebind(hair, method="FACE")
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=2e-5)
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)
    bpy.context.scene.frame_set(1)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=2e-5)


def test_roots_that_cannot_be_kept_stay_at_rest_and_are_selected():
    ob = deforming("grid with holes")
    hair = live_hair(ob)
    rest, faces = live_scenes.rest(hair).copy(), attributes.read(hair.data, ids.FACE)
    remove_faces(ob.data, {16, 17})
    bpy.context.scene.frame_set(1)
    assert "have changed" in live_kept.trouble(hair)
    rebind(hair, method="FACE")
    assert not live_kept.trouble(hair)
    lost = selected(hair.data)
    np.testing.assert_array_equal(lost, np.flatnonzero(np.isin(faces, [16, 17])))
    np.testing.assert_array_equal(attributes.read(hair.data, ids.FACE)[lost], -1)
    bpy.context.scene.frame_set(25)
    shown = scenes.strands(hair)
    np.testing.assert_array_equal(shown[lost], rest[lost])
    kept = np.setdiff1d(np.arange(len(rest)), lost)
    at = scenes.surface_without_addon(ob).evaluate(
        faces[kept], attributes.read(hair.data, ids.UV)[kept].astype(np.float64)
    )
    error = np.abs(shown[kept, 0] - at.position).max()
    assert error < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    bpy.context.scene.frame_set(1)
    rebind(hair)
    bpy.context.scene.frame_set(25)
    check_hair(ob, hair)
    assert np.abs(scenes.strands(hair)[lost] - rest[lost]).max() > 0.05


def test_all_that_follows_is_bound_in_its_own_way():
    ob = deforming("grid with holes")
    by_nodes, hair = scenes.add_hair(ob, follow="NODES"), live_hair(ob)
    renumber_faces(ob.data)
    rebind(hair)
    assert modifier_of(by_nodes)
    assert live_modifier_of(hair)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        check_hair(ob, hair)
        live_scenes.follow_truth.shown_strands(by_nodes)
        now = follow_truth.on_surface(ob, by_nodes.data)
        expected = follow_truth.moved(scenes.strands(by_nodes), by_nodes.data, now)
        error = np.abs(follow_truth.shown_strands(by_nodes) - expected).max()
        assert error < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)


def test_a_scene_in_which_live_following_is_off_poses_nothing():
    ob = deforming("grid with holes")
    hair = live_hair(ob)
    renumber_faces(ob.data)
    bpy.context.scene.limit_live = False
    shown = scenes.strands(hair).copy()
    rebind(hair)
    np.testing.assert_array_equal(scenes.strands(hair), shown)
    bpy.context.scene.limit_live = True
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)


def test_a_shape_at_rest_that_was_deleted_is_refused():
    ob = deforming("grid with holes")
    hair = live_hair(ob)
    hair.data.attributes.remove(hair.data.attributes[ids.LIVE_REST])
    refused(f"has no attribute {ids.LIVE_REST}: run Follow Limit Surface again", hair)
