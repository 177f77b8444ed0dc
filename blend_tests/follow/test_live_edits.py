# SPDX-License-Identifier: GPL-3.0-or-later
"""What artists do to hair that follows live: combing, adding, deleting, undo, saving, loading."""

import bpy
import live_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import live_kept, live_surface
from limit_surface.reading import attributes
from live_scenes import check_hair, deforming, follow

BOUND = 2e-5


@pytest.fixture
def hair() -> bpy.types.Object:
    made = scenes.add_hair(deforming("cross"), points=4, follow="NONE")
    follow(made)
    return made


def surface() -> bpy.types.Object:
    return bpy.data.objects["Cross"]


def comb(hair: bpy.types.Object, rows: slice = slice(0, 20)) -> np.ndarray:
    """Moves the points of some strands as a brush does, and returns all of them."""
    points = scenes.strands(hair).copy()
    points[rows, 1:] += [0.1, 0.2, -0.05]
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", points)
    hair.data.update_tag()
    return points


def go_to(frame: float) -> None:
    bpy.context.scene.frame_set(int(frame), subframe=frame % 1)


def test_combed_strands_stay_where_they_are_and_follow_from_there(hair):
    go_to(20)
    others = live_scenes.rest(hair)[20:].copy()
    combed = comb(hair)
    bpy.context.view_layer.update()
    np.testing.assert_array_equal(scenes.strands(hair), combed)
    np.testing.assert_array_equal(live_scenes.rest(hair)[20:], others)
    for frame in (30, 7.5, 1):
        go_to(frame)
        check_hair(surface(), hair)
    go_to(20)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=BOUND)


def test_a_look_at_another_frame_leaves_animated_values_as_they_are(hair):
    go_to(20)
    bent = surface().data.shape_keys.key_blocks["Bent"]
    before = bent.value
    depsgraph = bpy.context.evaluated_depsgraph_get()
    other = live_surface.surface_at(surface(), depsgraph, 3.0)
    assert bent.value == before
    surface().data.update_tag()
    bpy.context.view_layer.update()
    check_hair(surface(), hair)
    assert np.abs(other.positions - live_scenes.limit_of(hair).positions).max() > 0.1


def test_strands_that_are_combed_just_before_the_frame_changes_keep_their_shape(hair):
    go_to(20)
    combed = comb(hair)
    go_to(3)
    go_to(20)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=BOUND)


def test_strands_that_are_combed_without_the_extension_keep_their_shape(hair):
    go_to(20)
    combed = comb(hair)
    live_kept.forget()  # as when the file is loaded
    go_to(3)
    go_to(20)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=BOUND)


def test_combing_a_posed_bone_changes_nothing_else(hair):
    go_to(10)
    key = surface().data.shape_keys.key_blocks["Bent"]
    surface().data.shape_keys.animation_data_clear()
    key.value = 0.9
    bpy.context.view_layer.update()
    combed = comb(hair)
    key.value = 0.2
    bpy.context.view_layer.update()
    check_hair(surface(), hair)
    key.value = 0.9
    bpy.context.view_layer.update()
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=BOUND)


@pytest.mark.parametrize("is_updated_first", [False, True])
def test_scripts_may_change_the_binding_and_the_shape_at_rest(hair, is_updated_first):
    """What is kept from frame to frame is read again once a script tags the data."""
    go_to(10)
    rotation = attributes.read(hair.data, ids.REST_ROTATION)
    rotation[3] = 0  # the strand stands at rest
    attributes.write(hair.data, ids.REST_ROTATION, "QUATERNION", "CURVE", rotation)
    hair.data.update_tag()
    if is_updated_first:
        bpy.context.view_layer.update()
    go_to(20)
    rest = live_scenes.rest(hair)
    np.testing.assert_array_equal(scenes.strands(hair)[3], rest[3])

    rest = rest.copy()
    rest[3] += 1
    rest[5, 1:] = rest[5, :1] + 2 * (rest[5, 1:] - rest[5, :1])
    before = scenes.strands(hair)[5].copy()
    attributes.write(hair.data, ids.LIVE_REST, "FLOAT_VECTOR", "POINT", rest)
    hair.data.update_tag()
    if is_updated_first:
        bpy.context.view_layer.update()
    go_to(21)
    go_to(20)
    np.testing.assert_array_equal(scenes.strands(hair)[3], rest[3])
    longer = before[:1] + 2 * (before - before[:1])
    np.testing.assert_allclose(scenes.strands(hair)[5], longer, atol=BOUND)


def test_strands_that_are_added_later_stay(hair):
    go_to(15)
    count = len(hair.data.curves)
    hair.data.add_curves([4, 4])
    added = np.arange(24, dtype=np.float32).reshape(2, 4, 3)
    points = np.concatenate([scenes.strands(hair)[:count], added])
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", points)
    hair.data.update_tag()
    for frame in (30, 2):
        go_to(frame)
        np.testing.assert_array_equal(scenes.strands(hair)[count:], added)
        check_some(hair, slice(0, count))


def check_some(hair: bpy.types.Object, rows: slice) -> None:
    """Compares strands with those of other hair that nobody has edited."""
    other = bpy.data.objects.get("Other")
    if other is None:
        frame = bpy.context.scene.frame_current
        other = scenes.add_hair(surface(), points=4, follow="NONE")
        other.name = "Other"
        follow(other)
        go_to(frame)
    # it was placed in another frame, so that only the roots are comparable
    theirs = scenes.strands(other)[:, 0]
    np.testing.assert_allclose(scenes.strands(hair)[rows, 0], theirs, atol=BOUND)


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Python cannot do that before Blender 4.3")
def test_deleted_strands_do_not_matter(hair):
    go_to(15)
    hair.data.remove_curves(indices=list(range(0, 60, 3)))
    for frame in (30, 2):
        go_to(frame)
        check_hair(surface(), hair)


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Python cannot do that before Blender 4.3")
def test_strands_with_more_points_follow(hair):
    go_to(15)
    before = scenes.strands(hair)[0].copy()
    hair.data.resize_curves([7], indices=[0])
    points = attributes.read(hair.data, ids.POSITION)
    points[:7] = np.linspace(before[0], before[-1], 7)
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", points)
    hair.data.update_tag()
    go_to(30)
    assert np.abs(attributes.read(hair.data, ids.POSITION)[:7] - points[:7]).max() > 0.01
    go_to(15)
    np.testing.assert_allclose(attributes.read(hair.data, ids.POSITION), points, atol=BOUND)


def test_undo_and_redo(hair):
    go_to(20)
    bpy.ops.ed.undo_push(message="before")
    plain = scenes.strands(hair).copy()
    combed = comb(hair)
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="combed")
    bpy.ops.ed.undo()
    hair = bpy.data.objects[ids.HAIR_OBJECT]
    np.testing.assert_allclose(scenes.strands(hair), plain, atol=BOUND)
    go_to(3)
    check_hair(surface(), hair)
    go_to(20)
    np.testing.assert_allclose(scenes.strands(hair), plain, atol=BOUND)
    bpy.ops.ed.redo()
    hair = bpy.data.objects[ids.HAIR_OBJECT]
    go_to(3)
    go_to(20)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=BOUND)


def saved(path) -> bpy.types.Object:
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.data.objects[ids.HAIR_OBJECT]


def test_save_and_load(hair, tmp_path):
    go_to(20)
    combed = comb(hair)
    bpy.context.view_layer.update()
    go_to(9)
    before = {}
    for frame in (20, 30, 9):
        go_to(frame)
        before[frame] = scenes.strands(hair).tobytes()
    hair = saved(tmp_path / "a.blend")
    for frame in (9, 30, 20):
        go_to(frame)
        assert scenes.strands(hair).tobytes() == before[frame]
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=BOUND)


def test_edits_that_were_saved_before_they_were_taken_up(hair, tmp_path):
    go_to(20)
    combed = comb(hair)
    hair = saved(tmp_path / "a.blend")
    go_to(5)
    check_hair(surface(), hair)
    go_to(20)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=BOUND)


def test_two_runs_of_a_range_are_one_run(hair, tmp_path):
    """As on two machines of a farm, each of which loads the file and renders a part."""
    path = tmp_path / "a.blend"
    go_to(13)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))

    def run(frames):
        bpy.ops.wm.open_mainfile(filepath=str(path))
        found = {}
        for frame in frames:
            go_to(frame)
            found[frame] = scenes.strands(bpy.data.objects[ids.HAIR_OBJECT]).tobytes()
        return found

    assert run(range(1, 7)) | run(range(7, 13)) == run(range(1, 13))


def test_a_duplicate_of_everything_follows_its_own_surface(hair):
    for ob in (surface(), hair):
        ob.select_set(True)
    scenes.activate(hair)
    bpy.ops.object.duplicate()
    copy = next(ob for ob in bpy.context.selected_objects if ob.type == "CURVES")
    own = next(ob for ob in bpy.context.selected_objects if ob.type == "MESH")
    own.location.x += 10
    for frame in (30, 4):
        go_to(frame)
        check_hair(surface(), hair)
        check_hair(own, copy)


def test_it_follows_in_sculpt_mode(hair):
    scenes.activate(hair)
    bpy.ops.object.mode_set(mode="SCULPT_CURVES")
    go_to(12)
    check_hair(surface(), hair)
    combed = comb(hair)
    bpy.context.view_layer.update()
    bpy.ops.object.mode_set(mode="OBJECT")
    go_to(30)
    check_hair(surface(), hair)
    go_to(12)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=BOUND)


def test_modes_convert_into_each_other(hair):
    go_to(18)
    shown = scenes.strands(hair).copy()
    follow(hair, mode="NODES")
    assert [m.name for m in hair.modifiers] == [ids.FOLLOW_HAIR_GROUP]
    assert ids.LIVE_REST not in hair.data.attributes
    moved = live_scenes.follow_truth.shown_strands(hair)
    np.testing.assert_allclose(moved, shown, atol=BOUND)
    go_to(25)
    before = live_scenes.follow_truth.shown_strands(hair)
    follow(hair, mode="LIVE")
    assert [m.name for m in hair.modifiers] == [ids.FOLLOW_LIVE_GROUP]
    np.testing.assert_allclose(scenes.strands(hair), before, atol=BOUND)
    check_hair(surface(), hair)


def test_combed_hair_keeps_its_shape_when_the_mode_changes(hair):
    go_to(18)
    combed = comb(hair)
    follow(hair, mode="NODES")
    np.testing.assert_allclose(live_scenes.follow_truth.shown_strands(hair), combed, atol=BOUND)


def test_shared_data_are_refused():
    made = scenes.add_hair(deforming("cross"), follow="NONE")
    other = bpy.data.objects.new("Other", made.data)
    bpy.context.collection.objects.link(other)
    scenes.activate(made)
    with pytest.raises(RuntimeError, match="shares its data"):
        bpy.ops.object.limit_follow(mode="LIVE")
    assert not made.modifiers
