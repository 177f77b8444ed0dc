# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of different states of a file do not stand beside each other in a folder."""

import json

import bpy
import numpy as np
import pytest
from bakes import bake, contents
from limit_surface.bake_frames import command, sources
from limit_surface.bake_frames.frame_files import FrameFiles

NPZ = ("--format", "npz")
OVERWRITE = (*NPZ, "--overwrite")


@pytest.fixture
def shot(tmp_path):
    """A file whose frames 1 to 3 are baked; it is changed and saved then."""
    bpy.ops.mesh.primitive_cube_add()
    save(tmp_path / "shot.blend", 0)
    assert bake(tmp_path / "caches", "Cube", options=NPZ) == 0
    save(tmp_path / "shot.blend", 7)
    return tmp_path / "caches"


def save(path, height):
    bpy.data.objects["Cube"].location.z = height
    bpy.ops.wm.save_as_mainfile(filepath=str(path))


def heights(folder):
    return [float(np.load(p)["matrix_world"][2, 3]) for p in sorted(folder.glob("*.npz"))]


def test_a_part_of_the_frames_is_not_replaced(shot, capfd):
    before = contents(shot)
    assert bake(shot, "Cube", frames="2", options=OVERWRITE) == command.BAD_ARGUMENTS
    err = capfd.readouterr().err
    assert "holds 2 files that this job would not replace, such as Cube.0001.npz" in err
    assert "bake all frames and objects in one job" in err
    assert bake(shot, "Cube", frames="2") == command.BAD_ARGUMENTS
    assert contents(shot) == before


def test_frames_of_other_formats_and_objects_count(shot, capfd):
    assert bake(shot, "Cube", options=("--overwrite",)) == command.BAD_ARGUMENTS
    assert "3 files that this job would not replace" in capfd.readouterr().err
    bpy.ops.object.camera_add()
    assert bake(shot, "Camera", options=("--overwrite",)) == command.BAD_ARGUMENTS


def test_all_frames_are_replaced(shot):
    (shot / "notes.txt").touch()
    assert bake(shot, "Cube", frames="1-4", options=OVERWRITE) == 0
    assert heights(shot) == [7] * 4
    assert bake(shot, "Cube", frames="5-6", options=NPZ) == 0
    assert bake(shot, "Cube", frames="2", options=OVERWRITE) == 0  # nothing has changed
    assert heights(shot) == [7] * 6
    assert (shot / "notes.txt").exists()


def test_a_job_that_is_ended_leaves_none_of_the_old_frames(shot, monkeypatch):
    def ended(*_arguments):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(FrameFiles, "written", ended)
        with pytest.raises(KeyboardInterrupt):
            bake(shot, "Cube", options=OVERWRITE)
    assert bake(shot, "Cube", options=NPZ) == 0
    assert heights(shot) == [7] * 3


def test_records_of_earlier_versions(shot):
    record = shot / "bake.json"
    known = json.loads(record.read_text())
    record.write_text(json.dumps({key: known[key] for key in known if "sha256" not in key}))
    old = record.read_text()
    assert bake(shot, "Cube", frames="2", options=OVERWRITE) == 0
    assert record.read_text() == old
    assert bake(shot, "Cube", frames="1-3", options=OVERWRITE) == 0
    assert json.loads(record.read_text()).keys() == known.keys()


def test_linked_files_that_have_changed(tmp_path, capfd):
    bpy.ops.mesh.primitive_cube_add()
    library, shot, folder = tmp_path / "set.blend", tmp_path / "shot.blend", tmp_path / "caches"
    save(library, 0)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(library), link=True, relative=True) as (_, here):
        here.objects = ["Cube"]
    bpy.context.scene.collection.objects.link(here.objects[0])
    bpy.ops.wm.save_as_mainfile(filepath=str(shot))
    assert bake(folder, "Cube", frames="1", options=NPZ) == 0
    bpy.ops.wm.open_mainfile(filepath=str(library))
    save(library, 7)
    bpy.ops.wm.open_mainfile(filepath=str(shot))
    for options in (NPZ, OVERWRITE):
        assert bake(folder, "Cube", frames="2", options=options) == command.BAD_ARGUMENTS
    err = capfd.readouterr().err
    assert "linked files have changed since: set.blend" in err
    assert "or a file that it links has changed" in err
    assert bake(folder, "Cube", frames="1-2", options=OVERWRITE) == 0
    assert heights(folder) == [7, 7]


def test_changes_that_are_not_saved(shot, capfd, monkeypatch):
    """Blender without a window does not know of them."""
    assert not sources._has_unsaved_changes()
    monkeypatch.setattr(sources, "_has_unsaved_changes", lambda: True)
    assert bake(shot, "Cube", options=OVERWRITE) == command.BAD_ARGUMENTS
    assert "changes that are not saved. Save it first" in capfd.readouterr().err
    assert heights(shot) == [0, 0, 0]


def new_cube(height):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.mesh.primitive_cube_add(location=(0, 0, height))


def test_files_that_were_never_saved_do_not_mix(tmp_path, capfd):
    folder = tmp_path / "caches"
    new_cube(0)
    assert bake(folder, "Cube", frames="1-2", options=NPZ) == 0
    before = contents(folder)
    new_cube(7)
    assert bake(folder, "Cube", frames="3-4", options=NPZ) == command.BAD_ARGUMENTS
    err = capfd.readouterr().err
    assert f"{folder} holds a bake" in err
    assert "never saved: save it first, and give another folder, or replace all" in err
    save(tmp_path / "shot.blend", 7)
    assert bake(folder, "Cube", frames="3-4", options=NPZ) == command.BAD_ARGUMENTS
    err = capfd.readouterr().err
    assert "holds another bake (its .blend file had not been saved" in err
    assert contents(folder) == before
    assert bake(folder, "Cube", frames="1-4", options=OVERWRITE) == 0
    assert heights(folder) == [7] * 4
    new_cube(0)
    assert bake(folder, "Cube", frames="5", options=NPZ) == command.BAD_ARGUMENTS
    assert "never saved" in capfd.readouterr().err
    assert bake(folder, "Cube", frames="1-4", options=OVERWRITE) == 0
    assert heights(folder) == [0] * 4


def test_frames_whose_record_is_damaged_or_gone_are_not_kept(shot, capfd):
    """The file has changed since the frames were written, which nobody knows without the record."""
    record = shot / "bake.json"
    record.write_text("{")
    assert bake(shot, "Cube", frames="1-4", options=NPZ) == command.BAD_ARGUMENTS
    err = capfd.readouterr().err
    assert f"{record} is damaged" in err
    assert f"the frames in {shot}" in err
    assert "delete bake.json and the frames" in err
    record.unlink()
    assert bake(shot, "Cube", frames="1-4", options=NPZ) == command.BAD_ARGUMENTS
    assert f"{shot} holds frames but no bake.json" in capfd.readouterr().err
    assert heights(shot) == [0] * 3
    assert not record.exists()
    assert bake(shot, "Cube", frames="1-4", options=OVERWRITE) == 0
    assert heights(shot) == [7] * 4
    record.unlink()
    for path in shot.glob("*.npz"):
        path.unlink()
    assert bake(shot, "Cube", options=NPZ) == 0
    assert heights(shot) == [7] * 3
