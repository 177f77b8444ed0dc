# SPDX-License-Identifier: GPL-3.0-or-later
"""Which tiles of an image change: only those in which the UV map covers texels. The margin does not
reach into others, and it is not counted.
"""

import bpy
import numpy as np
import projection_truth as truth
import pytest
import scenes
import sculpts
from limit_surface.images import image_pixels

SIZE = 64
NEAR = 2 / SIZE  # the width of a strip between the map and the border of its tile


@pytest.fixture
def sheet():
    """Faces whose map lies in tile 1002, so near to 1001 that its margin reaches into that."""
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    scenes.add_uv_map(ob, lambda at: [1 + NEAR, 0.1] + 0.8 * at[:, :2] / (5, 4))
    truth.add_camera((2.5, 2, 9), type="ORTHO", ortho_scale=12)
    shown = bpy.data.images.new("Shown", 8, 8)
    shown.pixels.foreach_set(np.ones(8 * 8 * 4, np.float32))
    scenes.activate(ob)
    return ob


def noise(seed: int) -> np.ndarray:
    values = np.random.default_rng(seed).integers(0, 200, (SIZE, SIZE, 4)) / 255
    return values.astype(np.float32)


def tiled(*tiles: int) -> bpy.types.Image:
    pixels = {tile: noise(tile) for tile in tiles}
    return image_pixels.new_tiled("Tiles", pixels, is_float=False, is_data=False)


def project(**properties) -> None:
    done = bpy.ops.object.limit_project_image(image="Shown", occlusion=False, **properties)
    assert done == {"FINISHED"}


def test_the_margin_of_other_tiles_is_not_painted(sheet):
    image = tiled(1001, 1002, 1012)
    before = {tile: image_pixels.read(image, tile) for tile in (1001, 1002, 1012)}
    project(output="EXISTING", target="Tiles", margin=16)
    for tile in (1001, 1012):
        np.testing.assert_array_equal(image_pixels.read(image, tile), before[tile])
    painted = (image_pixels.read(image, 1002) != before[1002]).any(axis=2)
    assert painted[:, 0].any()  # in its own tile the margin is painted
    assert painted[SIZE // 2].mean() > 0.9


@pytest.mark.parametrize("existing", [None, "plain", "tiled"])
def test_images_without_the_tiles_of_the_map_are_refused(sheet, existing):
    where, how = "tile 1001", {"width": SIZE, "height": SIZE}
    if existing == "plain":
        image = bpy.data.images.new("Tiles", SIZE, SIZE)
    if existing == "tiled":
        image, where = tiled(1001, 1012), "any of the tiles"
    if existing:
        how = {"output": "EXISTING", "target": "Tiles"}
        before = image_pixels.read(image)
    contents = scenes.file_contents()
    with pytest.raises(RuntimeError, match=f"The UV map covers no texel of {where}: .*image that"):
        project(margin=16, **how)
    assert scenes.file_contents() == contents
    if existing:
        np.testing.assert_array_equal(image_pixels.read(image), before)


def test_all_operators_count_the_same_texels(sheet, capfd):
    """Each of 18 faces covers 8 x 10 texels."""
    scenes.add_uv_map(sheet, lambda at: (10 + at[:, :2] * (8, 10)) / SIZE)
    sheet.data.uv_layers.active = sheet.data.uv_layers[-1]
    target = sculpts.subdivided_copy(sheet, 1)
    size = {"width": SIZE, "height": SIZE}
    told = []
    for margin in (0, 16):
        capfd.readouterr()
        project(margin=margin, target=f"Painted {margin}", **size)
        bpy.ops.object.limit_bake_maps(maps={"POSITION"}, margin=margin, **size)
        bpy.ops.object.limit_bake_displacement(target=target.name, margin=margin, **size)
        said = capfd.readouterr().out.split("texels inside islands of the UV map")[:-1]
        told += [int(before.split()[-1].replace(",", "")) for before in said]
    assert told == [18 * 8 * 10] * 6


def test_a_bake_leaves_tiles_without_islands(sheet):
    bpy.ops.object.limit_bake_maps(
        maps={"POSITION"}, width=SIZE, height=SIZE, margin=16, tiles="ALL"
    )
    image = bpy.data.images["Holes Position"]
    assert image_pixels.checked(image).tiles.keys() == {1002}
    blank = {tile: np.full((SIZE, SIZE, 4), 0.25, np.float32) for tile in (1001, 1002)}
    for name in ("Holes Position", "Holes Displacement"):
        if name in bpy.data.images:
            bpy.data.images.remove(bpy.data.images[name])
        image_pixels.new_tiled(name, blank, is_float=True, is_data=True)
    target = sculpts.subdivided_copy(sheet, 1)
    size = {"width": SIZE, "height": SIZE, "margin": 16}
    bpy.ops.object.limit_bake_maps(maps={"POSITION"}, tiles="ALL", **size)
    bpy.ops.object.limit_bake_displacement(target=target.name, use_tiles=True, **size)
    for name in ("Holes Position", "Holes Displacement"):
        found = image_pixels.read(bpy.data.images[name], 1001)
        np.testing.assert_array_equal(found, blank[1001])
        assert (image_pixels.read(bpy.data.images[name], 1002) != blank[1002]).any()


@pytest.mark.parametrize("operator", ["limit_bake_maps", "limit_bake_displacement"])
def test_bakes_say_what_to_do_where_no_tile_has_texels(sheet, operator):
    target = sculpts.subdivided_copy(sheet, 1)
    how = {"maps": {"POSITION"}} if operator == "limit_bake_maps" else {"target": target.name}
    remedy = {
        "limit_bake_maps": "set Tiles to All",
        "limit_bake_displacement": "turn UDIM Tiles on",
    }
    match = f"covers no texel of tile 1001: {remedy[operator]}, or move its islands there"
    with pytest.raises(RuntimeError, match=match):
        getattr(bpy.ops.object, operator)(width=SIZE, height=SIZE, **how)
