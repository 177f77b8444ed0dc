# SPDX-License-Identifier: GPL-3.0-or-later
"""Images into which the displacement is baked once more, as after a change of the sculpt."""

import bpy
import numpy as np
import pytest
import scenes
import sculpts
from limit_surface.errors import RefusalError
from limit_surface.images import image_pixels, image_tiles

NAME = "Holes Displacement"


@pytest.fixture
def base():
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    scenes.add_uv_map(ob, lambda p: 0.1 + 0.15 * p[:, :2])
    return ob


@pytest.fixture
def sculpt(base):
    return sculpts.reshape(sculpts.subdivided_copy(base, 2), sculpts.ripples)


def bake(ob, target, **properties):
    scenes.activate(ob)
    order = {"width": 48, "height": 40, "space": "OBJECT", "target": target.name}
    return bpy.ops.object.limit_bake_displacement(**order | properties)


def lift(sculpt):
    """Changes the sculpt by one unit upwards."""
    sculpts.reshape(sculpt, lambda at: at + [0, 0, 1])


def heights(tile=1001):
    return image_pixels.read(bpy.data.images[NAME], tile)[..., 2]


def shift_uv(ob, by):
    layer = ob.data.uv_layers[0]
    uv = np.empty(2 * len(layer.data), np.float32)
    layer.data.foreach_get("uv", uv)
    layer.data.foreach_set("uv", uv + np.tile(np.float32([by, 0]), len(layer.data)))


def test_the_same_image_holds_the_new_numbers(base, sculpt):
    bake(base, sculpt)
    image, before = bpy.data.images[NAME], heights()
    lift(sculpt)
    bake(base, sculpt)
    assert [i.name for i in bpy.data.images if i.name.startswith(NAME)] == [NAME]
    assert bpy.data.images[NAME] == image
    covered = before != 0
    assert covered.mean() > 0.1
    np.testing.assert_allclose(heights()[covered] - before[covered], 1, atol=1e-5)


def test_undo_restores_the_numbers_of_the_first_bake(base, sculpt):
    bake(base, sculpt)
    before = heights()
    lift(sculpt)
    bpy.ops.ed.undo_push(message="before")
    bake(base, sculpt)
    after = heights()
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    np.testing.assert_array_equal(heights(), before)
    bpy.ops.ed.redo()
    np.testing.assert_array_equal(heights(), after)
    assert np.abs(after - before).max() > 0.9


def test_the_file_is_replaced(base, sculpt, tmp_path):
    path = tmp_path / "holes.exr"
    bake(base, sculpt, filepath=str(path))
    before = heights()
    lift(sculpt)
    bake(base, sculpt, filepath=str(path))
    image = bpy.data.images[NAME]
    loaded = bpy.data.images.load(str(path), check_existing=False)
    loaded.colorspace_settings.name = "Non-Color"
    np.testing.assert_array_equal(image_pixels.read(loaded)[..., 2], heights())
    assert np.abs(heights() - before).max() > 0.9
    assert not image.is_dirty


def test_the_number_of_the_tile_in_the_path(base, sculpt, tmp_path):
    for _ in range(2):
        bake(base, sculpt, filepath=str(tmp_path / "holes.<UDIM>.exr"))
        image = bpy.data.images[NAME]
        assert bpy.path.abspath(image.filepath) == str(tmp_path / "holes.1001.exr")
        assert np.abs(heights()).max() > 0.01
        lift(sculpt)


def test_an_image_with_unsaved_numbers_is_told(base, sculpt, tmp_path, capfd):
    bake(base, sculpt, filepath=str(tmp_path / "holes.exr"))
    lift(sculpt)
    bake(base, sculpt)
    assert f"does not store the changed pixels of {NAME}" in capfd.readouterr().out


def test_an_image_of_another_size_is_refused(base, sculpt):
    bake(base, sculpt)
    before = heights()
    with pytest.raises(RuntimeError, match="has 48 x 40 pixels: set .* or turn Reuse Image off"):
        bake(base, sculpt, width=64)
    np.testing.assert_array_equal(heights(), before)
    bake(base, sculpt, width=64, reuse=False)
    assert tuple(bpy.data.images[f"{NAME}.001"].size) == (64, 40)


def test_tiles_are_written_again(base, sculpt):
    shift_uv(base, 0.6)
    bake(base, sculpt, use_tiles=True)
    image = bpy.data.images[NAME]
    before = image_pixels.read(image, 1002)[..., 2]
    lift(sculpt)
    bake(base, sculpt, use_tiles=True)
    assert bpy.data.images[NAME] == image
    covered = before != 0
    assert covered.mean() > 0.1
    after = image_pixels.read(image, 1002)[..., 2]
    np.testing.assert_allclose(after[covered] - before[covered], 1, atol=1e-5)


def test_tiles_that_the_file_would_not_hold(base, sculpt, tmp_path):
    shift_uv(base, 0.6)
    bake(base, sculpt, use_tiles=True)
    with pytest.raises(RuntimeError, match="has tiles that the file would not hold"):
        bake(base, sculpt, filepath=str(tmp_path / "holes.exr"))
    assert len(bpy.data.images[NAME].tiles) == 2
    assert not list(tmp_path.iterdir())


def test_undo_of_tiles_in_files_that_are_replaced(base, sculpt, tmp_path):
    shift_uv(base, 0.6)
    how = {"use_tiles": True, "filepath": str(tmp_path / "tiles.<UDIM>.exr")}
    bake(base, sculpt, **how)
    before = {tile: heights(tile) for tile in (1001, 1002)}
    lift(sculpt)
    bpy.ops.ed.undo_push(message="before")
    bake(base, sculpt, **how)
    after = {tile: heights(tile) for tile in (1001, 1002)}
    bpy.ops.ed.undo_push(message="after")
    for step, expected in ((bpy.ops.ed.undo, before), (bpy.ops.ed.redo, after)):
        step()
        for tile in (1001, 1002):
            np.testing.assert_array_equal(heights(tile), expected[tile])
    assert np.abs(after[1002] - before[1002]).max() > 0.9


def test_a_refusal_after_the_work_leaves_the_files(base, sculpt, tmp_path, monkeypatch):
    how = {"filepath": str(tmp_path / "holes.exr")}
    bake(base, sculpt, **how)
    before, kept = (tmp_path / "holes.exr").read_bytes(), heights()
    lift(sculpt)

    def fails(*_what):
        raise RefusalError("no space is left")

    monkeypatch.setattr(image_tiles, "write_some", fails)
    with pytest.raises(RuntimeError, match="no space is left"):
        bake(base, sculpt, **how)
    monkeypatch.undo()
    assert [path.name for path in tmp_path.iterdir()] == ["holes.exr"]
    assert (tmp_path / "holes.exr").read_bytes() == before
    np.testing.assert_array_equal(heights(), kept)


def test_an_image_whose_tiles_cannot_be_read(base, sculpt, tmp_path):
    shift_uv(base, 0.6)
    image = bpy.data.images.new(
        NAME, 48, 40, alpha=True, float_buffer=True, is_data=True, tiled=True
    )
    with bpy.context.temp_override(edit_image=image):
        bpy.ops.image.tile_add(number=1002, width=48, height=40, float=True, alpha=True)
    with pytest.raises(RuntimeError, match=f"The tiled image {NAME} has "):
        bake(base, sculpt, use_tiles=True, filepath=str(tmp_path / "tiles.<UDIM>.exr"))
    assert not list(tmp_path.iterdir())


def test_a_tile_that_the_map_has_left_is_told(base, sculpt, tmp_path, capfd):
    how = {"use_tiles": True, "filepath": str(tmp_path / "tiles.<UDIM>.exr")}
    shift_uv(base, 0.6)
    bake(base, sculpt, **how)
    second = heights(1002)
    shift_uv(base, -0.6)
    lift(sculpt)
    bake(base, sculpt, **how)
    assert f"tile 1002 of {NAME} was not baked and shows" in capfd.readouterr().out
    np.testing.assert_array_equal(heights(1002), second)
    assert heights().max() > 0.9


def test_a_single_tile_that_is_not_the_first_needs_its_number_in_the_path(base, sculpt, tmp_path):
    shift_uv(base, 1)
    with pytest.raises(RuntimeError, match="Tile 1002 is saved in its own file: d.exr must"):
        bake(base, sculpt, use_tiles=True, filepath=str(tmp_path / "d.exr"))
    bake(base, sculpt, use_tiles=True, filepath=str(tmp_path / "d.<UDIM>.exr"))
    assert [path.name for path in tmp_path.iterdir()] == ["d.1002.exr"]
    assert bpy.data.images[NAME].source == "TILED"
