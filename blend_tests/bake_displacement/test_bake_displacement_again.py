# SPDX-License-Identifier: GPL-3.0-or-later
"""Images into which the displacement is baked once more, as after a change of the sculpt."""

import bpy
import numpy as np
import pytest
import scenes
import sculpts
from limit_surface.images import image_pixels

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


def heights():
    return image_pixels.read(bpy.data.images[NAME])[..., 2]


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
    layer = base.data.uv_layers[0]
    uv = np.empty(2 * len(layer.data), np.float32)
    layer.data.foreach_get("uv", uv)
    layer.data.foreach_set("uv", uv + np.tile(np.float32([0.6, 0]), len(layer.data)))
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
    layer = base.data.uv_layers[0]
    uv = np.empty(2 * len(layer.data), np.float32)
    layer.data.foreach_get("uv", uv)
    layer.data.foreach_set("uv", uv + np.tile(np.float32([0.6, 0]), len(layer.data)))
    bake(base, sculpt, use_tiles=True)
    with pytest.raises(RuntimeError, match="has tiles that the file would not hold"):
        bake(base, sculpt, filepath=str(tmp_path / "holes.exr"))
    assert len(bpy.data.images[NAME].tiles) == 2
    assert not list(tmp_path.iterdir())
