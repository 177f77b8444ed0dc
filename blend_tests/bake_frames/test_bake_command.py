# SPDX-License-Identifier: GPL-3.0-or-later
"""The command that bakes frames: its files, its progress, its exit codes."""

import json
import os
import re

import bpy
import numpy as np
import pytest
import scenes
from bakes import bake, contents, read_back, saved
from limit_surface import ids
from limit_surface.bake_frames import command
from limit_surface.reading import attributes

FORMATS = {"abc": ".abc", "usd": ".usd", "usda": ".usda", "npz": ".npz"}


@pytest.fixture
def waves():
    """A sheet on which waves run, and hair that follows it."""
    sheet = scenes.flat_grid(4)
    sheet.location, sheet.rotation_euler = (1, 2, 3), (0.3, 0.2, 0.1)
    sheet.modifiers.new("Wave", "WAVE").height = 0.4
    scenes.add_subsurf(sheet)
    scenes.add_hair(sheet, per_side=2)
    bpy.context.scene.frame_set(7)
    return sheet


def shown(ob, frame):
    """Returns the object's positions in the world in a frame."""
    bpy.context.scene.frame_set(frame)
    positions = attributes.read(evaluated(ob).data, "position").astype(np.float64)
    return scenes.transformed(evaluated(ob).matrix_world, positions)


def evaluated(ob):
    return ob.evaluated_get(bpy.context.evaluated_depsgraph_get())


@pytest.mark.parametrize("form", FORMATS)
def test_files_hold_the_objects_as_they_are_in_each_frame(waves, tmp_path, form):
    waves.modifiers["Subdivision"].levels = waves.modifiers["Subdivision"].render_levels = 0
    waves.modifiers["Subdivision"].use_limit_surface = False
    assert bake(tmp_path, "Flat", "Limit Hair", options=("--format", form)) == 0
    names = {f"{name}.{i:04}{FORMATS[form]}" for name in ("Flat", "Limit Hair") for i in (1, 2, 3)}
    assert contents(tmp_path).keys() == names | {"bake.json"}
    hair = bpy.data.objects["Limit Hair"]
    expected = {i: (shown(waves, i), shown(hair, i)) for i in (1, 2, 3)}
    for i, (sheet, strands) in expected.items():
        found = read_back(tmp_path / f"Flat.{i:04}{FORMATS[form]}", "MESH")
        np.testing.assert_allclose(found, sheet, rtol=0, atol=2e-6)
        found = read_back(tmp_path / f"Limit Hair.{i:04}{FORMATS[form]}", "CURVES")
        np.testing.assert_allclose(found, strands, rtol=0, atol=2e-6)
    assert np.abs(expected[3][0] - expected[1][0]).max() > 0.01


def test_arrays_say_what_they_are(waves, tmp_path):
    assert bake(tmp_path, "Flat", "Limit Hair", frames="2", options=("--format", "npz")) == 0
    bpy.context.scene.frame_set(2)
    hair = evaluated(bpy.data.objects["Limit Hair"])
    with np.load(tmp_path / "Limit Hair.0002.npz") as arrays:
        np.testing.assert_array_equal(arrays["curve_offsets"], np.arange(65) * 5)
        for name in (ids.POSITION, ids.FACE, ids.UV, "radius"):
            np.testing.assert_array_equal(arrays[name], attributes.read(hair.data, name))
        np.testing.assert_array_equal(arrays["matrix_world"], np.array(hair.matrix_world))
    with np.load(tmp_path / "Flat.0002.npz") as arrays:
        assert arrays["face_sizes"].sum() == len(arrays["face_vertices"])
        assert arrays["face_vertices"].max() == len(arrays["position"]) - 1


def test_scene_is_left_as_it_was(waves, tmp_path):
    before = scenes.file_contents()
    selected = [ob.name for ob in bpy.context.selected_objects]
    for form in FORMATS:
        assert bake(tmp_path / form, "Flat", options=("--format", form)) == 0
    assert scenes.file_contents() == before
    assert [ob.name for ob in bpy.context.selected_objects] == selected
    assert bpy.context.scene.frame_current == 7


def test_progress_is_one_line_a_frame(waves, tmp_path, capfd):
    bake(tmp_path, "Flat", "Limit Hair", frames="1-5", options=("--step", "2"))
    lines = [line for line in capfd.readouterr().out.splitlines() if line[:14] == "limit_surface:"]
    pattern = r"limit_surface: frame (\d) \((\d) of 3, \d+\.\d\d s\): 2 written"
    assert [re.fullmatch(pattern, line).groups() for line in lines[:-1]] == [
        ("1", "1"),
        ("3", "2"),
        ("5", "3"),
    ]
    assert lines[-1] == f"limit_surface: 3 frames in {tmp_path}: 6 written"


def test_files_that_exist_are_left_as_they_are(waves, tmp_path, capfd):
    folder = saved(tmp_path)
    assert bake(folder, "Flat") == 0
    whole = contents(folder)
    (folder / "Flat.0002.abc").unlink()
    (folder / "Flat.0003.abc").write_text("from another run")
    capfd.readouterr()
    assert bake(folder, "Flat") == 0
    assert "frames in" in capfd.readouterr().out
    found = contents(folder)
    assert found["Flat.0003.abc"] == b"from another run"
    assert len(found["Flat.0002.abc"]) > 1000
    assert bake(folder, "Flat", options=("--overwrite",)) == 0
    assert len(contents(folder)["Flat.0003.abc"]) > 1000
    assert contents(folder).keys() == whole.keys()


def hide_object(hair):
    hair.hide_viewport = True


def hide_by_its_eye(hair):
    hair.hide_set(True)


def hide_its_collection(hair):
    collection = bpy.data.collections.new("Hidden")
    bpy.context.scene.collection.children.link(collection)
    bpy.context.scene.collection.objects.unlink(hair)
    collection.objects.link(hair)
    bpy.context.view_layer.layer_collection.children["Hidden"].exclude = True


@pytest.mark.every(5)
@pytest.mark.parametrize("hide", [hide_object, hide_by_its_eye, hide_its_collection])
@pytest.mark.parametrize("form", FORMATS)
def test_hidden_in_the_viewport_is_baked(waves, tmp_path, form, hide):
    hair = bpy.data.objects["Limit Hair"]
    expected = shown(hair, 3)
    bpy.context.scene.frame_set(1)
    hide(hair)
    was = hair.hide_viewport, hair.visible_get()
    assert not hair.visible_get()
    assert bake(tmp_path, "Limit Hair", frames="2-3", options=("--format", form)) == 0
    assert (hair.hide_viewport, hair.visible_get()) == was
    found = read_back(tmp_path / f"Limit Hair.0003{FORMATS[form]}", "CURVES")
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-6)


@pytest.mark.parametrize("form", FORMATS)
def test_without_a_current_window(waves, tmp_path, form):
    """On Blender's command line none of the file's windows is the current one."""
    with bpy.context.temp_override(window=None):
        assert bpy.context.window is None
        assert not bpy.ops.wm.usd_export.poll()
        assert bake(tmp_path, "Flat", "Limit Hair", options=("--format", form)) == 0
    assert len(contents(tmp_path)) == 7


def test_names_of_files(waves, tmp_path):
    waves.name = "../Face: left"
    assert (
        bake(tmp_path / "new" / "folder", "../Face: left", frames="-2-10", options=("--step=12",))
        == 0
    )
    found = contents(tmp_path / "new" / "folder")
    assert found.keys() == {"_._Face_ left.-0002.abc", "_._Face_ left.0010.abc", "bake.json"}
    assert [path.name for path in tmp_path.iterdir()] == ["new"]


def test_what_its_animation_hides_in_the_viewport_is_baked(waves, tmp_path):
    hair = bpy.data.objects["Limit Hair"]
    expected = shown(hair, 3)
    hair.hide_viewport = True
    hair.keyframe_insert("hide_viewport", frame=1)
    bpy.context.scene.frame_set(1)
    assert bake(tmp_path, "Limit Hair", frames="3", options=("--format", "npz")) == 0
    found = read_back(tmp_path / "Limit Hair.0003.npz", "CURVES")
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-6)
    assert hair.hide_viewport


def test_attributes_that_no_array_can_hold_are_left_out(waves, tmp_path):
    waves.data.attributes.new(ids.SCALE, "FLOAT4X4", "POINT")
    assert bake(tmp_path, "Flat", frames="1", options=("--format", "npz")) == 0
    with np.load(tmp_path / "Flat.0001.npz") as arrays:
        assert ids.SCALE not in arrays


def test_arrays_without_points_are_named(waves, tmp_path, capfd):
    waves.vertex_groups.new(name="None")
    waves.modifiers.new("Mask", "MASK").vertex_group = "None"
    assert bake(tmp_path, "Flat", frames="1", options=("--format", "npz")) == 0
    out = capfd.readouterr().out
    assert "1 written; Flat shows no points: its file is empty" in out
    assert f"1 frame in {tmp_path}" in out


def test_an_object_that_is_not_rendered_in_a_frame(waves, tmp_path, capfd):
    for frame, hidden in ((1, False), (2, True), (3, False)):
        waves.hide_render = hidden
        waves.keyframe_insert("hide_render", frame=frame)
    assert bake(tmp_path, "Flat") == 0
    assert "1 written; Flat is disabled in renders: its file is empty" in capfd.readouterr().out


def test_a_frame_that_fails(waves, tmp_path, capfd):
    (tmp_path / "Flat.0002.abc").mkdir()
    assert bake(tmp_path, "Flat", options=("--overwrite",)) == command.FRAMES_FAILED
    out = capfd.readouterr().out
    assert "frame 2 (2 of 3" in out
    assert "1 failed; Flat.0002.abc: " in out
    assert out.splitlines()[-1].endswith(": 2 written, 1 failed")
    assert contents_of_files(tmp_path) == {"Flat.0001.abc", "Flat.0003.abc", "bake.json"}


def contents_of_files(folder):
    return {path.name for path in folder.iterdir() if path.is_file()}


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["bake", "--frames", "5-1", "--objects", "Flat"], "ends before it begins"),
        (["bake", "--frames", "x", "--objects", "Flat"], "neither a frame nor a range"),
        (["bake", "--frames", "1-1048575", "--objects", "Flat"], "no frames before -1048574"),
        (["bake", "--frames=-1048575-1", "--objects", "Flat"], "or after 1048574"),
        (["bake", "--frames", "1", "--step", "0", "--objects", "Flat"], "1 or more"),
        (["bake", "--frames", "1"], "--objects"),
        (["bake", "--frames", "1", "--objects", "Flat", "--format", "obj"], "'obj'"),
        (
            ["bake", "--frames", "1", "--objects", "Nobody"],
            "no file is open: the scene Scene has",
        ),
        (["cook"], "cook"),
        ([], "COMMAND"),
    ],
)
def test_wrong_arguments(waves, tmp_path, capfd, arguments, reason):
    where = ["--output", str(tmp_path / "out")] if arguments[:1] == ["bake"] else []
    assert command.main([*arguments, *where]) == command.BAD_ARGUMENTS
    assert reason in capfd.readouterr().err
    assert not (tmp_path / "out").exists()


def test_objects_that_cannot_be_baked(waves, tmp_path, capfd):
    waves.hide_render = True
    assert bake(tmp_path, "Flat") == command.BAD_ARGUMENTS
    assert "Flat is disabled in renders" in capfd.readouterr().err
    waves.hide_render = False
    bpy.data.objects["Limit Hair"].name = "FLAT"
    assert bake(tmp_path, "Flat", "FLAT") == command.BAD_ARGUMENTS
    assert "the same file flat" in capfd.readouterr().err
    bpy.ops.object.camera_add()
    assert bake(tmp_path, "Camera", options=("--format", "npz")) == command.BAD_ARGUMENTS
    message = "Camera is of the type Camera, which files of numpy cannot hold"
    assert message in capfd.readouterr().err
    assert not contents(tmp_path)
    assert bake(tmp_path, "Camera") == 0


def test_names_that_files_cannot_have(waves, tmp_path, capfd):
    """One job after the other must not take the files of the first for its own."""
    hair = bpy.data.objects["Limit Hair"]
    waves.name, hair.name = "a/b", "a:b"
    folder = saved(tmp_path)
    for name in ("a/b", "a:b"):
        assert bake(folder, name, options=("--format", "npz")) == 0
        assert "3 written" in capfd.readouterr().out
    names = contents_of_files(folder)
    assert len(names) == 2 * 3 + 1
    assert all(re.fullmatch(r"a_b_[0-9a-f]{8}\.000[123]\.npz|bake\.json", name) for name in names)


def test_a_folder_that_cannot_be_written(waves, tmp_path, capfd):
    (tmp_path / "file").touch()
    assert bake(tmp_path / "file", "Flat") == command.BAD_ARGUMENTS
    assert f"cannot write to {tmp_path / 'file'}" in capfd.readouterr().err


def test_a_folder_with_another_bake(waves, tmp_path, capfd):
    folder = saved(tmp_path)
    assert bake(folder, "Flat", frames="1") == 0
    record = json.loads((folder / "bake.json").read_text())
    (folder / "bake.json").write_text(json.dumps(record | {"blender": "3.6.0"}))
    assert bake(folder, "Flat", frames="2") == command.BAD_ARGUMENTS
    reason = f"blender 3.6.0, not {bpy.app.version_string}"
    assert reason in capfd.readouterr().err
    (folder / "bake.json").write_text("[]")
    assert bake(folder, "Flat", frames="2") == command.BAD_ARGUMENTS
    assert "bake.json is damaged" in capfd.readouterr().err


def test_two_files_of_one_name_do_not_mix(tmp_path, capfd):
    folder = tmp_path / "caches"

    def bake_cube(shot: str, height: float, *options: str) -> int:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        bpy.ops.mesh.primitive_cube_add(location=(0, 0, height))
        (tmp_path / shot).mkdir(exist_ok=True)
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / shot / "scene.blend"))
        return bake(folder, "Cube", frames="1", options=("--format", "npz", *options))

    def height() -> float:
        return float(np.load(folder / "Cube.0001.npz")["matrix_world"][2, 3])

    assert bake_cube("sh010", 0) == 0
    assert bake_cube("sh020", 7) == command.BAD_ARGUMENTS
    assert "the .blend file has changed since, or is another one" in capfd.readouterr().err
    assert height() == 0
    assert bake_cube("sh020", 7, "--overwrite") == 0
    assert height() == 7
    elsewhere = tmp_path / "mounted elsewhere"
    (tmp_path / "sh020").rename(elsewhere)
    bpy.ops.wm.open_mainfile(filepath=str(elsewhere / "scene.blend"))
    assert bake(folder, "Cube", frames="2", options=("--format", "npz")) == 0


def test_a_mesh_without_vertices_does_not_end_the_job(waves, tmp_path, capfd):
    empty = bpy.data.objects.new("Empty", bpy.data.meshes.new("Empty"))
    bpy.context.collection.objects.link(empty)
    assert bake(tmp_path, "Empty", "Flat", frames="1-2", options=("--format", "npz")) == 0
    assert "Empty shows no points: its file is empty" in capfd.readouterr().out
    assert len(contents_of_files(tmp_path)) == 5
    assert np.load(tmp_path / "Empty.0001.npz")["position"].shape == (0, 3)


def test_a_file_system_without_links(waves, tmp_path, monkeypatch):
    folder = saved(tmp_path)

    def no_links(*_paths):
        raise PermissionError("Operation not permitted")

    monkeypatch.setattr(os, "link", no_links)
    assert bake(folder, "Flat", frames="1") == 0
    assert bake(folder, "Flat", frames="2") == 0
    assert contents(folder).keys() == {"Flat.0001.abc", "Flat.0002.abc", "bake.json"}


def change_topology(sheet):
    mesh = bpy.data.meshes.new("Fewer")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    sheet.data = mesh


def test_hair_that_was_bound_to_another_topology(waves, tmp_path, capfd):
    change_topology(waves)
    assert bake(tmp_path, "Limit Hair") == command.STALE_BINDING
    message = "The faces of Flat have changed since Limit Hair was bound; object.limit_rebind"
    assert message in capfd.readouterr().err
    assert not contents(tmp_path)


def test_hair_that_does_not_follow_on_faces_that_are_gone(waves, tmp_path, capfd):
    hair = scenes.add_hair(waves, per_side=2, follow="NONE")
    change_topology(waves)
    assert bake(tmp_path, hair.name) == command.STALE_BINDING
    message = f"60 of the 64 places of {hair.name} are on faces that Flat does not have"
    assert message in capfd.readouterr().err
    assert not contents(tmp_path)


def test_a_surface_that_cannot_be_read(waves, tmp_path, capfd):
    waves.modifiers.clear()
    waves.modifiers.new("Multires", "MULTIRES")
    assert bake(tmp_path, "Limit Hair") == command.STALE_BINDING
    assert "Multiresolution" in capfd.readouterr().err


def test_a_format_that_this_blender_cannot_write(waves, tmp_path, capfd, monkeypatch):
    options = type("Options", (), {"alembic": False, "usd": True})
    monkeypatch.setattr("limit_surface.bake_frames.exporters.build_options", lambda: options)
    assert bake(tmp_path, "Flat") == command.BAD_ARGUMENTS
    assert "built without Alembic" in capfd.readouterr().err
    assert bake(tmp_path, "Flat", options=("--format", "usd")) == 0


def test_help(capfd):
    assert command.main(["bake", "--help"]) == 0
    out = capfd.readouterr().out
    assert "exit codes:" in out
    assert all(f"--{name}" in out for name in ("frames", "step", "objects", "output", "format"))


def test_a_frame_in_which_hair_is_at_rest(waves, tmp_path, capfd):
    """The faces change in frame 2, where a modifier is switched on."""
    scenes.activate(bpy.data.objects["Limit Hair"])
    bpy.ops.object.limit_follow()
    triangulate = waves.modifiers.new("Triangulate", "TRIANGULATE")
    waves.modifiers.move(waves.modifiers.find(triangulate.name), 0)
    for frame, is_on in ((1, False), (2, True), (3, False)):
        triangulate.show_viewport = is_on
        triangulate.keyframe_insert("show_viewport", frame=frame)
    assert bake(tmp_path, "Limit Hair", options=("--format", "npz")) == 1
    assert "Limit Hair is at rest in frame 2" in capfd.readouterr().out
    assert {"Limit Hair.0001.npz", "Limit Hair.0003.npz", "bake.json"} == contents(tmp_path).keys()


def test_a_follower_that_is_switched_off(waves, tmp_path, capfd):
    hair = bpy.data.objects["Limit Hair"]
    scenes.activate(hair)
    bpy.ops.object.limit_follow()
    hair.modifiers[0].show_render = False
    assert bake(tmp_path, "Limit Hair") == 3
    assert "its modifier Limit Hair is disabled" in capfd.readouterr().err


def test_an_attached_object_without_its_tables(waves, tmp_path, capfd):
    button = scenes.add_mesh("Button", [(0.5, 0.5, 0.1), (1, 0.5, 0.1), (0, 1, 0.2)], [(0, 1, 2)])
    bpy.ops.object.select_all(action="DESELECT")
    button.select_set(True)
    scenes.activate(waves)
    assert bpy.ops.object.limit_attach() == {"FINISHED"}
    assert bake(tmp_path / "whole", "Button") == 0
    for ob in list(bpy.data.objects):
        if ob.name.startswith(ids.TILES_TABLE):
            bpy.data.objects.remove(ob)
    assert bake(tmp_path / "broken", "Button") == 3
    assert "were deleted" in capfd.readouterr().err
