# SPDX-License-Identifier: GPL-3.0-or-later
"""A temporary folder without room: a refusal says so, and images stay as they were."""

import re
import resource
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.errors import RefusalError
from limit_surface.images import image_pixels, image_tiles

SIDE = 64
ROOM = 10_000  # bytes that a file may have: fewer than the image's pixels take


@contextmanager
def full_disk():
    """Files can be written only in part, as on a disk that is full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (ROOM, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def pixels(seed: int) -> np.ndarray:
    values = np.random.default_rng(seed).integers(0, 256, (SIDE, SIDE, 4)).astype(np.float32)
    values[..., 3] = 255
    return values / np.float32(255)


def temporary_files() -> set[str]:
    return {path.name for path in Path(bpy.app.tempdir).iterdir()}


@pytest.mark.parametrize("is_float", [False, True])
@pytest.mark.parametrize("tiles", [(1001,), (1001, 1002)])
def test_an_image_that_cannot_be_stored_for_undo(tiles, is_float):
    if len(tiles) > 1:
        before = {tile: pixels(tile) for tile in tiles}
        image = image_pixels.new_tiled("Image", before, is_float=is_float, is_data=True)
    else:
        image = image_pixels.new("Image", SIDE, SIDE, is_float=is_float, is_data=True)
        image_pixels.write(image, pixels(0), is_new=True)
    before, left = image_tiles.read_all(image), temporary_files()
    cause = re.escape(f"in the temporary folder {bpy.app.tempdir}: ")
    with full_disk(), pytest.raises(RefusalError, match=f"of Image cannot be stored.* {cause}"):
        image_pixels.write(image, pixels(1))
    assert temporary_files() == left
    assert not image.keys()
    for tile, values in image_tiles.read_all(image).items():
        np.testing.assert_array_equal(values, before[tile])


@pytest.mark.parametrize("is_float", [False, True])
def test_new_tiles_that_cannot_be_stored(is_float):
    tiles, left = {1001: pixels(1), 1002: pixels(2)}, temporary_files()
    with full_disk(), pytest.raises(RefusalError) as refusal:
        image_pixels.new_tiled("Image", tiles, is_float=is_float, is_data=True)
    assert str(refusal.value).startswith(bpy.app.tempdir)
    assert len(str(refusal.value).splitlines()) == 1
    assert temporary_files() == left
    assert not bpy.data.images


def test_an_operator_says_it_in_one_sentence(tmp_path):
    scenes.add_uv_map(scenes.grid_with_holes(), lambda at: 0.1 + 0.8 * at[:, :2] / (5, 4))
    how = {"maps": {"POSITION"}, "width": SIDE, "height": SIDE}
    bpy.ops.object.limit_bake_maps(**how)
    image = bpy.data.images["Holes Position"]
    before, left = image_pixels.read(image), temporary_files()
    bpy.context.active_object.data.vertices[0].co.z += 1
    said = "Error: The pixels of Holes Position cannot be stored for undo in the temporary folder"
    with full_disk(), pytest.raises(RuntimeError, match=said) as refusal:
        bpy.ops.object.limit_bake_maps(**how)
    assert len(str(refusal.value).splitlines()) == 1
    assert temporary_files() == left
    np.testing.assert_array_equal(image_pixels.read(image), before)
