# SPDX-License-Identifier: GPL-3.0-or-later
"""What could only be written wrongly or in part is refused, and leaves no file."""

import shutil

import bpy
import pytest
import scenes
from bakes import bake, contents
from limit_surface.bake_frames import command, usd_file
from limit_surface.errors import RefusalError
from limit_surface.images import image_files


def hair_on_sheet(follow):
    sheet = scenes.flat_grid(4)
    scenes.add_subsurf(sheet)
    return sheet, scenes.add_hair(sheet, per_side=2, follow=follow)


def test_options_that_are_repeated_name_all_objects(tmp_path):
    sheet, hair = hair_on_sheet("NONE")
    sheet.name, hair.name = "-Sheet", "-Hair"
    options = ("--objects=-Sheet", "--objects=-Hair")
    where = ("--output", str(tmp_path), "--format=npz")
    assert command.main(["bake", "--frames=1", *options, *where]) == 0
    assert contents(tmp_path).keys() == {"-Sheet.0001.npz", "-Hair.0001.npz", "bake.json"}


@pytest.mark.parametrize(("folder", "reason"), [("", "is empty"), ("//here", "relative to the")])
def test_folders_that_none_can_mean(tmp_path, capfd, monkeypatch, folder, reason):
    monkeypatch.chdir(tmp_path)
    hair_on_sheet("NONE")
    arguments = ("--frames=1", "--objects=Flat", f"--output={folder}")
    assert command.main(["bake", *arguments]) == command.BAD_ARGUMENTS
    assert reason in capfd.readouterr().err
    assert not contents(tmp_path)


@pytest.mark.parametrize("form", ["usd", "usda"])
def test_usd_files_that_are_cut_off(tmp_path, form):
    hair_on_sheet("NONE")
    assert bake(tmp_path, "Limit Hair", frames="1", options=("--format", form)) == 0
    whole = (tmp_path / f"Limit Hair.0001.{form}").read_bytes()
    cut = tmp_path / "cut"
    for size in (*range(0, len(whole) - 9, 97), len(whole.rstrip()) - 1):
        cut.write_bytes(whole[:size])
        with pytest.raises(RefusalError, match="the disk may be full"):
            usd_file.check_complete(cut)
    cut.write_bytes(whole)
    usd_file.check_complete(cut)
    cut.unlink()
    assert contents(tmp_path).keys() == {f"Limit Hair.0001.{form}", "bake.json"}


class FullDisk:
    """An image whose files lack their last bytes."""

    class colorspace_settings:  # noqa: N801
        name = "sRGB"

    def __init__(self, image):
        self._image = image

    def save_render(self, path, scene):
        self._image.save_render(path, scene=scene)
        with open(path, "rb+") as file:
            file.truncate(file.seek(0, 2) // 2)


@pytest.mark.parametrize("kind", [image_files.PNG_8, image_files.PNG_16])
def test_png_files_that_are_cut_off(tmp_path, kind):
    image = bpy.data.images.new("Image", 32, 32)
    image_files.save_copy(image, tmp_path / "whole.png", kind)
    with pytest.raises(RefusalError, match="the disk may be full"):
        image_files.save_copy(FullDisk(image), tmp_path / "cut.png", kind)


@pytest.mark.parametrize("form", ["abc", "usd"])
def test_a_flat_surface_needs_arrays(tmp_path, capfd, form):
    sheet, _hair = hair_on_sheet("NONE")
    sheet.scale = (0, 1, 1)
    assert bake(tmp_path, "Limit Hair", frames="1", options=("--format", form)) == 1
    assert "Flat has a scale of 0 along an axis" in capfd.readouterr().out
    assert bake(tmp_path / "npz", "Limit Hair", frames="1", options=("--format", "npz")) == 0


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
@pytest.mark.parametrize("form", ["abc", "usd"])
def test_faces_that_only_renders_have(tmp_path, capfd, form, follow):
    sheet, _hair = hair_on_sheet(follow)
    modifier = sheet.modifiers.new("Triangulate", "TRIANGULATE")
    sheet.modifiers.move(sheet.modifiers.find(modifier.name), 0)
    modifier.show_viewport = False
    assert bake(tmp_path, "Limit Hair", frames="1", options=("--format", form)) == 1
    assert "enable the modifier Triangulate in both" in capfd.readouterr().out
    assert bake(tmp_path / "npz", "Limit Hair", frames="1", options=("--format", "npz")) == 0
    wave = sheet.modifiers.new("Wave", "WAVE")
    sheet.modifiers.remove(modifier)
    sheet.modifiers.move(sheet.modifiers.find(wave.name), 0)
    wave.show_viewport = False
    assert bake(tmp_path / form, "Limit Hair", frames="1", options=("--format", form)) == 0


def test_libraries_that_are_missing(tmp_path, capfd):
    hair_on_sheet("NONE")
    (tmp_path / "a").mkdir()
    library = tmp_path / "a" / "library.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(library))
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(str(library), link=True) as (there, here):
        here.objects = there.objects
    for ob in here.objects:
        bpy.context.scene.collection.objects.link(ob)
    shot = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(shot))
    assert bake(tmp_path / "out", "Limit Hair", frames="1") == 0
    shutil.rmtree(tmp_path / "a")
    bpy.ops.wm.open_mainfile(filepath=str(shot))
    capfd.readouterr()
    assert bake(tmp_path / "more", "Limit Hair", frames="1") == command.BAD_ARGUMENTS
    assert "is missing" in capfd.readouterr().err
    assert not (tmp_path / "more").exists()


def test_objects_that_share_data_are_all_refused(tmp_path, capfd):
    _sheet, hair = hair_on_sheet("LIVE")
    other = hair.copy()  # Alt D
    bpy.context.scene.collection.objects.link(other)
    other.location.x += 1
    bpy.context.view_layer.update()
    for ob in (hair, other):
        assert bake(tmp_path, ob.name, frames="1") == 3
        assert "shares its data with" in capfd.readouterr().err


@pytest.mark.parametrize(("form", "suffix"), [("npz", ".0001.npz"), ("abc", ".-0100.abc")])
def test_names_that_are_too_long_for_files(tmp_path, capfd, form, suffix):
    """Blender 5 allows names of 255 bytes, and earlier versions 63."""
    sheet, _hair = hair_on_sheet("NONE")
    frame = "--frames=" + suffix.split(".")[1]
    where = ("--output", str(tmp_path), "--format", form)
    sheet.name = "ä" * 126 + "x"
    if len(sheet.name) < 100:
        pytest.skip("this Blender has no names of that length")
    assert command.main(["bake", frame, "--objects", sheet.name, *where]) == command.BAD_ARGUMENTS
    err = capfd.readouterr().err
    assert f"has {253 + len(suffix)} bytes, and 255 are allowed. Give the object a" in err
    assert not contents(tmp_path)
    sheet.name = "ä" * 122
    assert command.main(["bake", frame, "--objects", sheet.name, *where]) == 0
    assert contents(tmp_path).keys() == {sheet.name + suffix, "bake.json"}
