# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps that are baked once more, into images and files that exist."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.errors import RefusalError
from limit_surface.images import image_files, image_pixels, image_tiles

SIZE = {"width": 8, "height": 8, "margin": 0}


@pytest.fixture
def mesh():
    """A square whose UV map fills one tile."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=3)
    return bpy.context.active_object


def over_tiles(ob, count, first=0):
    """Lays the UV map over so many tiles of a row."""
    at = np.array([ob.data.vertices[loop.vertex_index].co[:2] for loop in ob.data.loops])
    uv = (at / 2 + 0.5) * (count, 1) + (first, 0)
    ob.data.uv_layers[0].uv.foreach_set("vector", uv.astype(np.float32).ravel())


def lift(by):
    for vertex in bpy.data.objects["Grid"].data.vertices:
        vertex.co.z += by
    bpy.data.objects["Grid"].data.update()


def bake(maps=("POSITION",), **how):
    how = {**SIZE, **how}
    assert bpy.ops.object.limit_bake_maps("EXEC_DEFAULT", True, maps=set(maps), **how) == {
        "FINISHED"
    }
    return bpy.data.images["Grid Position"]


def heights(image=None):
    """Returns the height in the middle of each tile."""
    image = image or bpy.data.images["Grid Position"]
    return {
        tile: pytest.approx(float(pixels[4, 4, 2]), abs=1e-3)
        for tile, pixels in image_tiles.read_all(image).items()
    }


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@pytest.mark.parametrize("form", ["EXR_32", "EXR_16", "PNG_8"])
def test_undo_of_tiles_in_files_that_are_replaced(mesh, tmp_path, form):
    over_tiles(mesh, 2)
    how = {"tiles": "ALL", "folder": str(tmp_path), "format": form}
    mesh.data.vertices[0].co.z = -8  # so that the range of heights in PNG files holds both
    mesh.data.vertices[8].co.z = 8
    bpy.ops.ed.undo_push(message="before")
    bake(**how)
    before = image_tiles.read_all(bpy.data.images["Grid Position"])
    for vertex in mesh.data.vertices[3:6]:
        vertex.co.z += 5
    mesh.data.update()
    bpy.ops.ed.undo_push(message="move")
    bake(**how)
    after = image_tiles.read_all(bpy.data.images["Grid Position"])
    assert np.abs(after[1001] - before[1001]).max() > 0.1
    for step, expected in ((bpy.ops.ed.undo, before), (bpy.ops.ed.redo, after)):
        step()
        found = image_tiles.read_all(bpy.data.images["Grid Position"])
        for tile in (1001, 1002):
            np.testing.assert_array_equal(found[tile], expected[tile])


def test_undo_of_tiles_whose_files_are_gone(mesh, tmp_path):
    over_tiles(mesh, 2)
    how = {"tiles": "ALL", "folder": str(tmp_path)}
    bake(**how)
    lift(3)
    bpy.ops.ed.undo_push(message="move")
    bake(**how)
    for path in tmp_path.iterdir():
        path.unlink()
    bpy.ops.ed.undo()
    assert heights() == {1001: 0, 1002: 0}


def test_the_error_names_the_file_that_is_wanted(mesh, tmp_path, monkeypatch):
    def fails(_pixels, path, _kind):
        raise RefusalError(f"{path} cannot be written: no space is left")

    monkeypatch.setattr(image_files, "save_pixels", fails)
    path = tmp_path / "Grid_Position.exr"
    refused(f"Error: {path} cannot be written: no space is left", folder=str(tmp_path))


@pytest.mark.parametrize("in_files", [False, True])
def test_a_single_tile_that_is_not_the_first(mesh, tmp_path, in_files):
    over_tiles(mesh, 1, first=1)
    how = {"tiles": "ALL", "folder": str(tmp_path) if in_files else ""}
    for height in (0, 3):
        image = bake(**how)
        assert image.source == "TILED"
        assert heights() == {1002: height}
        lift(3)
    files = ["Grid_Position.1002.exr"] if in_files else []
    assert sorted(path.name for path in tmp_path.iterdir()) == files


def test_tiles_that_the_files_would_not_hold(mesh, tmp_path):
    over_tiles(mesh, 2)
    bake(tiles="ALL")
    lift(3)
    refused(
        "has tiles that the file would not hold: .* or turn Reuse Images off",
        tiles="FIRST",
        folder=str(tmp_path),
    )
    assert heights() == {1001: 0, 1002: 0}
    assert not list(tmp_path.iterdir())


def test_one_tile_of_an_image_in_files(mesh, tmp_path, capfd):
    over_tiles(mesh, 2)
    bake(tiles="ALL", folder=str(tmp_path))
    second = (tmp_path / "Grid_Position.1002.exr").read_bytes()
    bpy.data.images["Grid Position"].filepath_raw = f"{tmp_path}/../{tmp_path.name}/" + (
        "Grid_Position.<UDIM>.exr"
    )
    lift(3)
    image = bake(tiles="FIRST", folder=str(tmp_path))
    assert "tile 1002 of Grid Position was not baked and shows" in capfd.readouterr().out
    assert heights() == {1001: 3, 1002: 0}
    assert not image.packed_files
    assert contents(tmp_path).keys() == {f"Grid_Position.{tile}.exr" for tile in (1001, 1002)}
    assert (tmp_path / "Grid_Position.1002.exr").read_bytes() == second


@pytest.mark.parametrize("in_files", [False, True])
def test_tiles_that_the_map_has_left_are_told(mesh, tmp_path, capfd, in_files):
    how = {"tiles": "ALL", "folder": str(tmp_path) if in_files else ""}
    over_tiles(mesh, 4)
    bake(**how)
    assert "was not baked" not in capfd.readouterr().out
    over_tiles(mesh, 2)
    lift(5)
    bake(**how)
    told = "tiles 1003, 1004 of Grid Position were not baked and show what they showed before"
    assert told in capfd.readouterr().out
    assert heights() == {1001: 5, 1002: 5, 1003: 0, 1004: 0}


def test_tiles_that_the_folder_has_are_told_of_a_new_image(mesh, tmp_path, capfd):
    how = {"tiles": "ALL", "folder": str(tmp_path)}
    over_tiles(mesh, 3)
    bpy.data.images.remove(bake(**how))
    over_tiles(mesh, 2)
    bake(**how)
    assert "tile 1003 of Grid Position was not baked" in capfd.readouterr().out


def refused(match, maps=("POSITION",), **how):
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_bake_maps(maps=set(maps), **{**SIZE, **how})
    assert scenes.file_contents() == before


@pytest.mark.parametrize("exists", [False, True])
@pytest.mark.parametrize("in_files", [False, True])
def test_a_second_image_that_cannot_be_written(mesh, tmp_path, monkeypatch, exists, in_files):
    over_tiles(mesh, 2)
    how = {"tiles": "ALL", "folder": str(tmp_path) if in_files else ""}
    if exists:
        bake(**how)
    other = bpy.data.images.new(
        "Grid Normal", 8, 8, alpha=True, float_buffer=True, is_data=True, tiled=True
    )
    with bpy.context.temp_override(edit_image=other):
        bpy.ops.image.tile_add(number=1002, width=8, height=8, float=True, alpha=True)
    before = contents(tmp_path)
    lift(3)
    work = []
    monkeypatch.setattr("limit_surface.bake_maps.operator.bake", work.append)
    refused("The tiled image Grid Normal has ", ("POSITION", "NORMAL_OBJECT"), **how)
    assert not work
    assert contents(tmp_path) == before
    if exists:
        assert heights() == {1001: 0, 1002: 0}


@pytest.mark.parametrize("in_files", [False, True])
@pytest.mark.parametrize("tiles", [1, 2])
def test_a_second_image_that_fails_after_the_bake(mesh, tmp_path, monkeypatch, in_files, tiles):
    over_tiles(mesh, tiles)
    how = {"tiles": "ALL", "folder": str(tmp_path) if in_files else ""}
    image = bake(**how)
    bake(("NORMAL_OBJECT",), **how)
    packed, before = len(image.packed_files), contents(tmp_path)
    lift(3)
    write = image_tiles.write_some

    def fails(of, *pixels):
        if of.name == "Grid Normal":
            raise RefusalError("no space is left")
        write(of, *pixels)

    monkeypatch.setattr(image_tiles, "write_some", fails)
    maps = ("POSITION", "NORMAL_OBJECT", "CAVITY")
    with pytest.raises(RuntimeError, match="no space is left"):
        bpy.ops.object.limit_bake_maps(maps=set(maps), **{**SIZE, **how})
    assert sorted(bpy.data.images.keys()) == ["Grid Normal", "Grid Position"]
    assert heights() == dict.fromkeys(heights(), 0)
    assert len(image.packed_files) == packed
    assert contents(tmp_path) == before


def test_a_file_that_cannot_be_replaced(mesh, tmp_path):
    (tmp_path / "Grid_Normal.exr").mkdir()
    how = {"folder": str(tmp_path)}
    bake(**how)
    before = contents(tmp_path)
    lift(3)
    maps = ("POSITION", "NORMAL_OBJECT")
    refused("Grid_Normal.exr cannot be written: it is a folder", maps, **how)
    assert contents(tmp_path) == before
    assert heights() == {1001: 0}


def test_a_second_file_that_fails_leaves_the_first_one(mesh, tmp_path, monkeypatch):
    how = {"folder": str(tmp_path)}
    maps = ("POSITION", "NORMAL_OBJECT")
    bake(maps, **how)
    before = contents(tmp_path)
    lift(3)
    save, calls = image_files.save_pixels, []

    def fails(*what):
        calls.append(what)
        if len(calls) == 2:
            raise RefusalError("no space is left")
        save(*what)

    monkeypatch.setattr(image_files, "save_pixels", fails)
    refused("no space is left", maps, **how)
    assert contents(tmp_path) == before
    assert heights() == {1001: 0}


def test_tiles_whose_file_is_gone(mesh, tmp_path):
    over_tiles(mesh, 2)
    how = {"tiles": "ALL", "folder": str(tmp_path)}
    image = bake(**how)
    assert image_pixels.checked(image).tiles.keys() == {1001, 1002}
    (tmp_path / "Grid_Position.1002.exr").unlink()
    refused("shows tile 1002 from .*Grid_Position.1002.exr, which does not exist", **how)
