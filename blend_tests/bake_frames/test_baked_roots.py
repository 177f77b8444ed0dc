# SPDX-License-Identifier: GPL-3.0-or-later
"""Roots in caches are where `limitsurf` says, on the control mesh of each frame."""

import re

import bpy
import follow_truth
import live_scenes
import numpy as np
import pytest
import scenes
from bakes import bake, read_back
from limit_surface.bake_frames import command
from mathutils import Euler, Matrix

FRAMES = range(1, 13)
SUFFIXES = {"abc": ".abc", "usd": ".usd", "npz": ".npz"}


def deforming(scene):
    """Returns a surface that waves and bends, turns and grows."""
    ob = scenes.SCENES[scene]()
    follow_truth.animate(ob)
    scenes.add_subsurf(ob)
    for frame, angle, size in ((1, 0.2, 1.0), (12, 0.9, 1.3)):
        ob.rotation_euler = (angle, 0.3, -angle)
        ob.scale = (size, 1, 1)
        ob.keyframe_insert("rotation_euler", frame=frame)
        ob.keyframe_insert("scale", frame=frame)
    ob.location = (0.3, -0.2, 0.5)
    return ob


def roots_in_world(ob, thing, frame):
    bpy.context.scene.frame_set(frame)
    on_surface = follow_truth.on_surface(ob, thing.data).position
    return scenes.transformed(np.array(ob.matrix_world, np.float64), on_surface)


#: Each scene in one form; the rest is among the slow tests
ALL = [(scene, form) for scene in scenes.SCENES for form in SUFFIXES]
FAST = [case for case in ALL if case[1] == "npz"]


@pytest.mark.parametrize(
    ("scene", "form"), [*FAST, *scenes.slow(*(case for case in ALL if case not in FAST))]
)
def test_roots_are_on_the_limit_surface_in_each_frame(tmp_path, scene, form):
    ob = deforming(scene)
    hair = scenes.add_hair(ob, per_side=2, points=3, follow="NODES")
    points = scenes.add_points(ob, per_side=2, follow="NODES")
    options = ("--format", form)
    assert bake(tmp_path, hair.name, points.name, frames="1-12", options=options) == 0
    size = 2 * follow_truth.diagonal(ob)  # it grows and bends
    first = roots_in_world(ob, hair, 1)
    for frame in FRAMES:
        expected = {thing: roots_in_world(ob, thing, frame) for thing in (hair, points)}
        for thing, kind, step in ((hair, "CURVES", 3), (points, "MESH", 1)):
            path = tmp_path / f"{thing.name}.{frame:04}{SUFFIXES[form]}"
            error = np.abs(read_back(path, kind)[::step] - expected[thing]).max()
            assert error < follow_truth.POSITION_BOUND * size, (frame, thing.name)
    assert np.abs(first - roots_in_world(ob, hair, 12)).max() > 0.1


@pytest.mark.parametrize("form", SUFFIXES)
def test_live_roots_are_on_the_limit_surface_in_each_frame(tmp_path, form):
    ob = deforming("mixed polygons")
    hair = scenes.add_hair(ob, per_side=3, points=3, follow="NONE")
    points = scenes.add_points(ob, per_side=3, follow="NONE")
    live_scenes.follow(hair, points)
    hair.hide_viewport = True
    options = ("--format", form)
    assert bake(tmp_path, hair.name, points.name, frames="1-5", options=options) == 0
    hair.hide_viewport = False
    bound = 2 * follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    for frame in range(1, 6):
        for thing, kind, step in ((hair, "CURVES", 3), (points, "MESH", 1)):
            path = tmp_path / f"{thing.name}.{frame:04}{SUFFIXES[form]}"
            error = read_back(path, kind)[::step] - roots_in_world(ob, thing, frame)
            assert np.abs(error).max() < bound, (frame, thing.name)


@pytest.fixture
def live_hair():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, per_side=2, follow="NONE")
    live_scenes.follow(hair)
    return hair


def test_live_following_that_is_switched_off(live_hair, tmp_path, capfd):
    bpy.context.scene.limit_live = False
    check_refused(tmp_path, capfd, "Limit Hair follows live, which is switched off in Scene")


def test_live_hair_that_cannot_be_posed(live_hair, tmp_path, capfd):
    live_hair.data.attributes.remove(live_hair.data.attributes["limit_uv"])
    check_refused(tmp_path, capfd, "has no attribute limit_uv any more")


def test_live_hair_that_cannot_be_posed_in_some_frames(live_hair, tmp_path, capfd):
    ob = bpy.data.objects["Cross"]
    ob.modifiers.new("Fewer faces", "MASK").vertex_group = ob.vertex_groups.new(name="None").name
    ob.modifiers.move(ob.modifiers.find("Fewer faces"), 0)
    for frame, on in ((1, False), (4, True), (5, False)):
        for shown in ("show_viewport", "show_render"):
            setattr(ob.modifiers["Fewer faces"], shown, on)
            ob.modifiers["Fewer faces"].keyframe_insert(shown, frame=frame)
    assert bake(tmp_path, "Limit Hair", frames="3-5") == command.FRAMES_FAILED
    assert {path.name for path in tmp_path.iterdir()} == {
        "Limit Hair.0003.abc",
        "Limit Hair.0005.abc",
        "bake.json",
    }
    assert "1 failed; Limit Hair.0004.abc: Cross has no faces" in capfd.readouterr().out


def test_hair_with_a_transform_of_its_own(tmp_path):
    ob = deforming("cross")
    hair = scenes.add_hair(ob, per_side=3, follow="NONE")
    hair.parent = None
    turn = Euler((0.5, 0.1, 0.2)).to_matrix().to_4x4()
    hair.matrix_world = Matrix.Translation((1, 2, 3)) @ turn @ Matrix.Diagonal((0.5, 0.7, 0.9, 1))
    scenes.activate(hair)
    assert bpy.ops.object.limit_follow(mode="NODES") == {"FINISHED"}
    assert bake(tmp_path, hair.name, frames="9") == 0
    error = read_back(tmp_path / "Limit Hair.0009.abc", "CURVES")[::5] - roots_in_world(ob, hair, 9)
    assert np.abs(error).max() < 2 * follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)


@pytest.fixture
def sheared():
    """A surface that was parented where it stood to a turned and stretched empty, and turned
    then: relative to its parent it is sheared.
    """
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    empty.rotation_euler, empty.scale = (0.5, 0.3, 0.7), (1, 2, 0.5)
    ob = deforming("cross")
    ob.parent = empty
    bpy.context.view_layer.update()
    ob.matrix_parent_inverse = empty.matrix_world.inverted()
    scenes.add_hair(ob, per_side=2, points=3, follow="NODES")
    return ob


def test_shear_is_in_usd_files(sheared, tmp_path):
    assert bake(tmp_path, "Limit Hair", frames="9", options=("--format", "usda")) == 0
    text = (tmp_path / "Limit Hair.0009.usda").read_text()
    points = usd_numbers(r"point3f\[\] points", text)[0].reshape(-1, 3)
    for matrix in reversed(usd_numbers(r"matrix4d xformOp:transform", text)):
        points = scenes.transformed(matrix.reshape(4, 4).T, points)
    expected = roots_in_world(sheared, bpy.data.objects["Limit Hair"], 9)
    bound = 2 * follow_truth.POSITION_BOUND * follow_truth.diagonal(sheared)
    assert np.abs(points[::3] - expected).max() < bound


def usd_numbers(name, text):
    """Returns the numbers of each attribute of this name in a text file of USD. Blender's own
    import would leave out shear.
    """
    found = re.findall(rf"{name} = (.*)", text)
    return [np.array(re.findall(r"[-+.\de]+", values), float) for values in found]


def test_shear_is_refused_as_alembic(sheared, tmp_path, capfd):
    assert bake(tmp_path, "Limit Hair", frames="9") == command.FRAMES_FAILED
    assert "1 failed; Limit Hair.0009.abc: Cross is sheared by its own" in capfd.readouterr().out


def test_flat_surfaces_are_not_taken_for_sheared(tmp_path):
    """Rounding looks like shear where an axis is a thousand times shorter than the others."""
    ob = deforming("cross")
    ob.animation_data_clear()
    ob.rotation_euler, ob.scale = (0.5, 0.3, 0.7), (1, 0.8, 1e-3)
    bpy.context.view_layer.update()
    hair = scenes.add_hair(ob, per_side=2, points=3, follow="NODES")
    assert bake(tmp_path, hair.name, frames="5") == 0
    error = read_back(tmp_path / "Limit Hair.0005.abc", "CURVES")[::3] - roots_in_world(ob, hair, 5)
    assert np.abs(error).max() < 1e-4 * follow_truth.diagonal(ob)


@pytest.fixture
def bound():
    ob = deforming("cross")
    scenes.add_hair(ob, per_side=2, follow="NODES")
    return ob


def check_refused(tmp_path, capfd, reason):
    assert bake(tmp_path, "Limit Hair", frames="3-5") == command.STALE_BINDING
    assert reason in capfd.readouterr().err
    assert not list(tmp_path.iterdir())
    assert bpy.context.scene.frame_current == 1


def test_a_crease_that_came_later(bound, tmp_path, capfd):
    crease = bound.data.edge_creases_ensure()
    crease.data[3].value = 0.5
    check_refused(tmp_path, capfd, "The creases or subdivision settings of Cross have changed")


def test_tables_that_have_been_deleted(bound, tmp_path, capfd):
    bpy.data.objects.remove(bpy.data.objects["Limit Tiles of Cross"])
    check_refused(tmp_path, capfd, "tables that Limit Hair reads were deleted; object.limit_follow")


def test_points_of_the_tables_that_have_been_deleted(bound, tmp_path, capfd):
    bpy.data.objects.remove(bpy.data.objects["Limit Points of Cross"])
    check_refused(tmp_path, capfd, "tables that Limit Hair reads were deleted; object.limit_follow")


def test_a_modifier_that_has_been_deleted(bound, tmp_path, capfd):
    bpy.data.objects["Limit Hair"].modifiers.clear()
    check_refused(tmp_path, capfd, "Limit Hair has lost the modifier by which it followed")


def test_a_surface_that_hands_nothing_on(bound, tmp_path, capfd):
    bound.modifiers["Limit Capture"].show_render = False
    check_refused(tmp_path, capfd, "the modifier Limit Capture is disabled")
