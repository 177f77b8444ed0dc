# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points of one surface that are joined into one object."""

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.placing import live_kept
from limit_surface.reading import attributes
from live_scenes import follow

ADD = {"hair": scenes.add_hair, "points": scenes.add_points}


def join(thing: bpy.types.Object, into: bpy.types.Object) -> None:
    if into.type == "CURVES" and bpy.app.version < (4, 5):
        pytest.skip(f"Blender {bpy.app.version_string} cannot join hair")
    bpy.ops.object.select_all(action="DESELECT")
    for ob in (thing, into):
        ob.select_set(True)
    scenes.activate(into)
    assert bpy.ops.object.join() == {"FINISHED"}


def first_points(thing: bpy.types.Object) -> np.ndarray:
    shown = follow_truth.shown(thing, ids.POSITION)
    return shown.reshape(len(attributes.read(thing.data, ids.FACE)), -1, 3)[:, 0]


def check(ob: bpy.types.Object, thing: bpy.types.Object) -> None:
    """Everything stands on the surface, in several frames."""
    for frame in (25, 4, 12):
        bpy.context.scene.frame_set(frame)
        now = follow_truth.on_surface(ob, thing.data, follow_truth.relation(ob, thing))
        error = np.abs(first_points(thing) - now.position).max()
        assert error < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
        if ids.ROTATION in thing.data.attributes:  # as points have it along the normal
            turned = follow_truth.matrices(follow_truth.shown(thing, ids.ROTATION))
            np.testing.assert_allclose(turned[:, :, 2], now.frame[:, :, 2], atol=1e-4)


@pytest.mark.parametrize("kind", ADD)
@pytest.mark.parametrize(
    ("ways", "mode"),
    [
        (("NONE", "LIVE"), "LIVE"),
        (("NODES", "LIVE"), "LIVE"),
        (("LIVE", "NONE"), "LIVE"),
        (("LIVE", "NONE"), "NODES"),
        (("LIVE", "NODES"), "NODES"),
        (("LIVE", "NODES"), "LIVE"),
        (("LIVE", "LIVE"), "LIVE"),
        (("NONE", "LIVE"), "NODES"),
    ],
)
def test_all_that_was_joined_follows_after_the_operator_was_run(kind, ways, mode):
    ob = deforming("grid with holes")
    thing, into = (ADD[kind](ob, follow=way, seed=i) for i, way in enumerate(ways))
    bpy.context.scene.frame_set(20)
    join(thing, into)
    bpy.context.scene.frame_set(8)
    follow(into, mode=mode)
    check(ob, into)


@pytest.mark.parametrize("kind", ADD)
def test_what_was_joined_stays_and_keeps_its_place_until_the_operator_is_run(kind):
    ob = deforming("grid with holes")
    thing, into = (ADD[kind](ob, follow=way, seed=i) for i, way in enumerate(("NONE", "LIVE")))
    own = len(attributes.read(into.data, ids.FACE))
    before = attributes.read(thing.data, ids.POSITION)
    join(thing, into)
    for frame in (20, 8, 1, 30):
        bpy.context.scene.frame_set(frame)
        moved = follow_truth.shown(into, ids.POSITION)[-len(before) :]
        np.testing.assert_allclose(moved, before, atol=1e-6)
        if kind == "points":
            assert np.abs(follow_truth.shown(into, ids.ROTATION)[own:]).max(axis=1).min() > 0
    assert attributes.read(into.data, ids.REST_ROTATION).any(axis=1).all()


@pytest.mark.parametrize("ways", [("NONE", "LIVE"), ("LIVE", "NODES")])
def test_what_was_joined_follows_after_it_was_bound_again(ways):
    ob = deforming("grid with holes")
    thing, into = (scenes.add_hair(ob, follow=way, seed=i) for i, way in enumerate(ways))
    bpy.context.scene.frame_set(20)
    join(thing, into)
    bpy.context.scene.frame_set(1)
    scenes.activate(into)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    check(ob, into)


def test_what_was_joined_goes_to_its_place_when_something_else_is_bound():
    ob = deforming("grid with holes")
    thing, into = (
        scenes.add_hair(ob, follow=way, seed=i) for i, way in enumerate(("LIVE", "NODES"))
    )
    bpy.context.scene.frame_set(20)
    join(thing, into)
    scenes.add_points(ob, follow="NODES")
    check(ob, into)


def without_frames(hair: bpy.types.Object) -> np.ndarray:
    """Deletes rest orientations as versions before 0.2.0 did when strands were joined, and returns
    which strands have none.
    """
    rotation = attributes.read(hair.data, ids.REST_ROTATION)
    has_none = np.arange(len(rotation)) % 3 == 0
    rotation[has_none] = 0
    attributes.write(hair.data, ids.REST_ROTATION, "QUATERNION", "CURVE", rotation)
    hair.data.update_tag()
    return has_none


def test_a_file_from_before_0_2_0_says_what_stays_still(tmp_path, capfd):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="LIVE")
    expected = f"Limit Hair: {without_frames(hair).sum()} strands stay still, because the file"
    path = str(tmp_path / "earlier.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert f"Limit Surface: {expected}" in capfd.readouterr().out
    bpy.context.scene.frame_set(5)
    hair = bpy.data.objects["Limit Hair"]
    assert live_kept.trouble(hair).startswith(expected)
    assert live_kept.remedy(hair) == ids.FOLLOW
    scenes.activate(hair)
    assert bpy.ops.object.limit_follow(mode="LIVE") == {"FINISHED"}
    assert (live_kept.trouble(hair), live_kept.remedy(hair)) == ("", "")


@pytest.mark.parametrize("how", ["LIVE", "NODES", "rebind"])
def test_strands_from_before_0_2_0_are_bound_where_they_are(how):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="LIVE")
    without_frames(hair)
    if how == "rebind":
        scenes.activate(hair)
        assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    else:
        follow(hair, mode=how)
    assert attributes.read(hair.data, ids.REST_ROTATION).any(axis=1).all()
    if how != "NODES":
        assert not live_kept.trouble(hair)
    check(ob, hair)
