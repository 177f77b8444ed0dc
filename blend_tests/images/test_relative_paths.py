# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of baked images by paths relative to the .blend file, so that both can move together."""

import shutil

import bpy
import numpy as np
import pytest
import scenes
import sculpts
from limit_surface.images import image_files, image_tiles

SIZE = {"width": 16, "height": 16}


@pytest.fixture
def project(tmp_path):
    """A folder with the .blend file and a folder for maps."""
    (tmp_path / "project" / "maps").mkdir(parents=True)
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    scenes.add_uv_map(ob, lambda at: 0.1 + 0.8 * at[:, :2] / (5, 4))
    sculpts.reshape(sculpts.subdivided_copy(ob, 1), sculpts.ripples)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "project" / "scene.blend"))
    return tmp_path / "project"


def widen_map(factor: float) -> None:
    layer = bpy.context.active_object.data.uv_layers[0]
    for corner in layer.data:
        corner.uv.x *= factor


def bake_maps(folder: str, *, tiled: bool) -> bpy.types.Image:
    how = {"tiles": "ALL" if tiled else "FIRST", "folder": folder}
    bpy.ops.object.limit_bake_maps(maps={"POSITION"}, **SIZE, **how)
    return bpy.data.images["Holes Position"]


def bake_displacement(folder: str, *, tiled: bool) -> bpy.types.Image:
    path = f"{folder}/moved.<UDIM>.exr" if tiled else f"{folder}/moved.exr"
    how = {"use_tiles": tiled, "filepath": path, "target": "Sculpt"}
    bpy.ops.object.limit_bake_displacement(**SIZE, **how)
    return bpy.data.images["Holes Displacement"]


FILES = {bake_maps: "Holes_Position", bake_displacement: "moved"}


@pytest.mark.parametrize("tiled", [False, True])
@pytest.mark.parametrize("bake", FILES)
def test_a_relative_path_stays_relative(project, bake, tiled, tmp_path):
    widen_map(1.5 if tiled else 1)
    name = f"//maps/{FILES[bake]}{'.<UDIM>' if tiled else ''}.exr"
    for _again in range(2):  # a new image, then the same one
        image = bake("//maps", tiled=tiled)
        assert image.filepath_raw == name
        assert not image.is_dirty
    pixels, image_name = image_tiles.read_all(image), image.name
    assert len(pixels) == 1 + tiled
    bpy.ops.wm.save_mainfile()
    shutil.move(project, tmp_path / "elsewhere")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "elsewhere" / "scene.blend"))
    image = bpy.data.images[image_name]
    found = image_tiles.read_all(image)
    for tile, expected in pixels.items():
        np.testing.assert_array_equal(found[tile], expected)
    assert bake("//maps", tiled=tiled) == image
    assert image.filepath_raw == name
    assert not project.exists()


@pytest.mark.parametrize("bake", FILES)
def test_an_absolute_path_stays_absolute(project, bake):
    for _again in range(2):
        image = bake(str(project / "maps"), tiled=False)
        assert image.filepath_raw == str(project / "maps" / f"{FILES[bake]}.exr")


def test_the_folder_of_the_file_itself(project):
    assert bake_maps("//", tiled=False).filepath_raw == "//Holes_Position.exr"
    (project.parent / "beside").mkdir()
    image = bake_maps("//../beside", tiled=False)
    assert image.filepath_raw == "//../beside/Holes_Position.exr"


def test_a_file_that_is_saved_elsewhere_meanwhile(project, tmp_path):
    given = image_files.given_path("//maps")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    assert (given / "a.exr").stored == "//project/maps/a.exr"
    assert given.absolute == project / "maps"


def test_a_relative_path_needs_a_saved_file(project):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scenes.add_uv_map(scenes.grid_with_holes(), lambda at: 0.1 + 0.8 * at[:, :2] / (5, 4))
    with pytest.raises(RuntimeError, match="has not been saved: save it first"):
        bake_maps("//maps", tiled=False)
