# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that share their data and follow live: the points are written once for all of them."""

import bpy
import follow_truth
import live_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import live_kept
from limit_surface.placing.followers import live_modifier_of, modifier_of
from live_scenes import FRAMES, check_hair, deforming, follow
from mathutils import Matrix


@pytest.fixture
def pair() -> tuple[bpy.types.Object, bpy.types.Object]:
    """Adds hair, and another object with its data in the same place."""
    hair = scenes.add_hair(deforming("cross"), points=4, follow="NONE")
    twin = hair.copy()
    bpy.context.collection.objects.link(twin)
    bpy.context.view_layer.update()
    return hair, twin


def surface() -> bpy.types.Object:
    return bpy.data.objects["Cross"]


def elsewhere(twin: bpy.types.Object) -> None:
    twin.matrix_world = Matrix.Translation((1, 0, 0)) @ twin.matrix_world
    bpy.context.view_layer.update()


def check_both(pair: tuple[bpy.types.Object, bpy.types.Object]) -> None:
    for thing in pair:
        check_hair(surface(), thing)


def test_all_users_follow(pair, capfd):
    hair, twin = pair
    follow(hair)
    assert live_modifier_of(hair)
    assert live_modifier_of(twin)
    count = len(hair.data.curves)
    assert f"{count:,} strands and points follow Cross live" in capfd.readouterr().out
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        check_both(pair)


def test_points_in_one_place_but_under_other_parents_follow():
    ob = deforming("cross")
    points = scenes.add_points(ob, follow="NONE")
    twin = points.copy()
    bpy.context.collection.objects.link(twin)
    twin.parent = None
    twin.matrix_world = points.matrix_world
    bpy.context.view_layer.update()
    follow(points)
    bpy.context.scene.frame_set(30)
    now = follow_truth.on_surface(ob, points.data)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    for thing in (points, twin):
        assert np.abs(follow_truth.shown(thing, ids.POSITION) - now.position).max() < bound


def test_users_in_other_places_are_refused(pair):
    hair, twin = pair
    elsewhere(twin)
    contents = scenes.file_contents()
    with pytest.raises(RuntimeError, match=r"Limit Hair\.001, which has another transform"):
        follow(hair)
    assert scenes.file_contents() == contents
    assert live_modifier_of(hair) is None


def test_a_user_that_is_moved_later_stops_all_and_names_the_reason(pair):
    hair, twin = pair
    follow(hair)
    shown = scenes.strands(hair).copy()
    before = twin.matrix_world.copy()
    elsewhere(twin)
    assert "another transform relative to Cross" in live_kept.trouble(hair)
    bpy.context.scene.frame_set(30)
    np.testing.assert_array_equal(scenes.strands(hair), shown)
    twin.matrix_world = before
    bpy.context.view_layer.update()
    assert not live_kept.trouble(hair)
    check_both(pair)


def test_all_users_are_unbound_together(pair):
    hair, twin = pair
    follow(twin)
    rest = live_scenes.rest(hair).copy()
    bpy.context.scene.frame_set(20)
    shown = scenes.strands(hair).copy()
    for shape, expected in (("SHOWN", shown), ("REST", shown)):
        scenes.activate(hair)
        assert bpy.ops.object.limit_unbind(shape=shape) == {"FINISHED"}
        assert not hair.modifiers
        assert not twin.modifiers
        np.testing.assert_allclose(scenes.strands(hair), expected, atol=1e-5)
        follow(hair)
    assert np.abs(rest - shown).max() > 0.05


def test_all_users_are_converted_together(pair):
    hair, twin = pair
    follow(hair)
    bpy.context.scene.frame_set(20)
    shown = follow_truth.shown_strands(hair)
    follow(hair, mode="NODES")
    for thing in pair:
        assert live_modifier_of(thing) is None
        assert modifier_of(thing)
        np.testing.assert_allclose(follow_truth.shown_strands(thing), shown, atol=2e-5)
    follow(twin, mode="LIVE")
    for thing in pair:
        assert live_modifier_of(thing)
        assert modifier_of(thing) is None
        np.testing.assert_allclose(follow_truth.shown_strands(thing), shown, atol=2e-5)
