# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes into existing images whose files are missing: nothing of them is kept, so they are made
anew, unless tiles would have to be kept.
"""

import bpy
import numpy as np
import pytest
import scenes
import sculpts
from limit_surface.errors import RefusalError
from limit_surface.images import file_replacing, image_pixels, image_tiles

SIZE = {"width": 16, "height": 16}


@pytest.fixture
def folder(tmp_path):
    """A folder for maps, beside the .blend file."""
    (tmp_path / "maps").mkdir()
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    scenes.add_uv_map(ob, lambda at: 0.1 + 0.8 * at[:, :2] / (5, 4))
    sculpts.reshape(sculpts.subdivided_copy(ob, 1), sculpts.ripples)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    return tmp_path / "maps"


def over_two_tiles() -> None:
    for corner in bpy.context.active_object.data.uv_layers[0].data:
        corner.uv.x *= 1.5


def bake_maps(folder="", tiled=False, **how) -> bpy.types.Image:
    how = {"tiles": "ALL" if tiled else "FIRST", "folder": str(folder), **how}
    bpy.ops.object.limit_bake_maps("EXEC_DEFAULT", True, maps={"POSITION"}, **SIZE, **how)
    return bpy.data.images["Holes Position"]


def bake_displacement(folder="", tiled=False, **how) -> bpy.types.Image:
    path = f"{folder}/{'moved.<UDIM>.exr' if tiled else 'moved.exr'}" if folder else ""
    how = {"use_tiles": tiled, "filepath": path, "target": "Sculpt", **how}
    bpy.ops.object.limit_bake_displacement("EXEC_DEFAULT", True, **SIZE, **how)
    return bpy.data.images["Holes Displacement"]


BAKES = pytest.mark.parametrize("bake", [bake_maps, bake_displacement])


def lose(folder, pattern="*") -> None:
    """Removes files, and opens the .blend file, so that Blender does not hold their pixels."""
    bpy.ops.wm.save_mainfile()
    for path in folder.glob(pattern):
        path.unlink()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)


def check_same(image: bpy.types.Image, expected: dict[int, np.ndarray]) -> None:
    found = image_tiles.read_all(image)
    assert found.keys() == expected.keys()
    for tile, pixels in expected.items():
        np.testing.assert_array_equal(found[tile], pixels)


@pytest.mark.parametrize("tiled", [False, True])
@BAKES
def test_the_file_is_written_again(folder, bake, tiled):
    if tiled:
        over_two_tiles()
    expected = image_tiles.read_all(bake(folder, tiled))
    lose(folder)
    names = set(bpy.data.images.keys())
    image = bake(folder, tiled)
    check_same(image, expected)
    assert set(bpy.data.images.keys()) == names
    assert len(list(folder.iterdir())) == len(expected)
    assert not image.packed_files
    assert not image.is_dirty
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    check_same(bpy.data.images[names.pop()], expected)


@pytest.mark.parametrize("tiled", [False, True])
@BAKES
def test_without_a_folder_the_image_is_packed(folder, bake, tiled, capfd):
    if tiled:
        over_two_tiles()
    image = bake(folder, tiled)
    name, expected = image.name, image_tiles.read_all(image)
    lose(folder)
    capfd.readouterr()
    path = bpy.data.images[name].filepath_raw
    check_same(bake(tiled=tiled), expected)
    assert bpy.data.images[name].filepath_raw == path
    told = f"the file of {name} is missing or cannot be read, so the .blend file now holds"
    assert told in capfd.readouterr().out
    assert not list(folder.iterdir())
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    check_same(bpy.data.images[name], expected)
    bake(tiled=tiled)
    assert told not in capfd.readouterr().out


def test_another_size_and_format_is_no_obstacle(folder):
    bake_maps(folder)
    lose(folder)
    how = {"width": 8, "height": 24, "format": "PNG_8"}
    bpy.ops.object.limit_bake_maps(maps={"POSITION"}, folder=str(folder), **how)
    image = bpy.data.images["Holes Position"]
    assert tuple(image.size) == (8, 24)
    assert not image.is_float
    assert [path.name for path in folder.iterdir()] == ["Holes_Position.png"]


def test_one_tile_is_written_again_and_the_other_is_kept(folder):
    over_two_tiles()
    expected = image_tiles.read_all(bake_maps(folder, tiled=True))
    lose(folder, "*1002*")
    image = bpy.data.images["Holes Position"]
    assert image_pixels.checked(image).tiles.keys() == {1001}
    check_same(bake_maps(folder, tiled=True), expected)


def test_tiles_that_would_be_kept_are_refused_if_the_first_is_missing(folder):
    """Without the first tile Blender does not tell which kind of pixels the others have."""
    over_two_tiles()
    bake_maps(folder, tiled=True)
    lose(folder, "*1001*")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    remedy = "check that its file exists. You can also set another name, or turn Reuse Images off"
    with pytest.raises(RuntimeError, match=f"Holes Position has no pixels: {remedy}"):
        bake_maps(folder, tiled=True)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize("in_files", [False, True])
def test_undo_and_redo(folder, in_files):
    expected = image_tiles.read_all(bake_maps(folder))
    lose(folder)
    bpy.ops.ed.undo_push(message="opened")
    where = folder if in_files else ""
    bake_maps(where)
    bpy.ops.ed.undo()
    image = bpy.data.images["Holes Position"]
    assert image.source == "FILE"
    assert not image.packed_files
    assert image_tiles.has_pixels(image) == in_files  # files that were written stay
    bpy.ops.ed.redo()
    check_same(bpy.data.images["Holes Position"], expected)
    bake_maps(where)
    check_same(bpy.data.images["Holes Position"], expected)


@pytest.mark.parametrize("tiled", [False, True])
def test_a_bake_that_fails_leaves_the_image(folder, tiled, monkeypatch):
    if tiled:
        over_two_tiles()
    bake_maps(folder, tiled)
    lose(folder)
    before = bpy.data.images["Holes Position"].filepath_raw

    def fails(_files):
        raise RefusalError("no space is left")

    monkeypatch.setattr(file_replacing.Files, "place", fails)
    with pytest.raises(RuntimeError, match="no space is left"):
        bake_maps(folder, tiled)
    image = bpy.data.images["Holes Position"]
    assert image.source == ("TILED" if tiled else "FILE")
    assert image.filepath_raw == before
    assert not image.packed_files
    assert not image.keys()
    assert not image_tiles.has_pixels(image)
    assert not list(folder.iterdir())


def test_pixels_of_another_depth(folder):
    bake_maps()
    remedy = "set another format or name, or turn Reuse Images off"
    with pytest.raises(RuntimeError, match=f"float pixels, which do not fit .*: {remedy}"):
        bake_maps(format="PNG_8")
    bpy.data.images.new("Holes Displacement", 16, 16, is_data=True)
    remedy = "set another name, or turn Reuse Image off"
    with pytest.raises(RuntimeError, match=f"8-bit pixels, which do not fit the format: {remedy}"):
        bake_displacement()
