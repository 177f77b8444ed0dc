# SPDX-License-Identifier: GPL-3.0-or-later
"""Images whose alpha does not tell how much their colors cover: it is not used, or channel-packed,
which means that it holds other data, such as roughness.
"""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.images import image_pixels

SIDE = 16
MODES = pytest.mark.parametrize("mode", ["CHANNEL_PACKED", "NONE"])
DEPTHS = pytest.mark.parametrize("is_float", [False, True], ids=["8", "float"])


@pytest.fixture(autouse=True)
def square():
    """A square that a planar empty covers, texel by texel."""
    positions = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    ob = scenes.add_mesh("Square", positions, [(0, 1, 2, 3)])
    scenes.add_uv_map(ob, lambda at: at[:, :2])
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    empty.location, empty.empty_display_size = (0.5, 0.5, 1), 0.5
    bpy.context.view_layer.update()
    return ob


def values(seed: int) -> np.ndarray:
    """Returns multiples of 1/255; alpha goes from 0 to 1 along the rows."""
    found = np.random.default_rng(seed).integers(0, 256, (SIDE, SIDE, 4)).astype(np.float32)
    found[..., 3] = np.linspace(0, 255, SIDE).round()
    return found / np.float32(255)


def add_image(name: str, pixels: np.ndarray, is_float: bool, mode: str) -> bpy.types.Image:
    image = bpy.data.images.new(name, SIDE, SIDE, alpha=True, float_buffer=is_float)
    image.alpha_mode = mode
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image


def project(**properties) -> None:
    how = {"source": "PLANAR", "empty": "Empty", "image": "Above", "margin": 0}
    assert bpy.ops.object.limit_project_image(**how | properties) == {"FINISHED"}


def light(coded: np.ndarray) -> np.ndarray:
    return np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)


def coded(light: np.ndarray) -> np.ndarray:
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


@MODES
@DEPTHS
@pytest.mark.parametrize("opacity", [1.0, 0.5])
def test_alpha_stays_and_colors_are_mixed_by_what_covers(mode, is_float, opacity):
    below, above = values(1), values(2)
    target = add_image("Below", below, is_float, mode)
    add_image("Above", above, False, "STRAIGHT")
    before = image_pixels.read(target)
    project(output="EXISTING", target="Below", opacity=opacity)
    found = image_pixels.read(target)
    np.testing.assert_array_equal(found[..., 3], before[..., 3])
    np.testing.assert_allclose(found[..., 3], below[..., 3], atol=1e-6)
    covers = opacity * above[..., 3:]
    under = below[..., :3] if is_float else light(below[..., :3])
    mixed = covers * light(above[..., :3]) + (1 - covers) * under
    expected = mixed if is_float else coded(mixed)
    tolerance = 1e-5 if is_float else 1.01 / 255
    np.testing.assert_allclose(found[..., :3], expected, atol=tolerance)


@DEPTHS
def test_tiled_images_keep_alpha_and_what_it_does_not_cover(is_float):
    tiles = {1001: values(1), 1002: values(3)}
    target = image_pixels.new_tiled("Below", tiles, is_float=is_float, is_data=True)
    target.alpha_mode = "CHANNEL_PACKED"
    before = {tile: image_pixels.read(target, tile) for tile in tiles}
    np.testing.assert_allclose(before[1002], tiles[1002], atol=1e-6)
    add_image("Above", np.ones((SIDE, SIDE, 4), np.float32), False, "STRAIGHT")
    project(output="EXISTING", target="Below", opacity=0.5)
    np.testing.assert_array_equal(image_pixels.read(target, 1002), before[1002])
    found = image_pixels.read(target, 1001)
    np.testing.assert_array_equal(found[..., 3], before[1001][..., 3])
    expected = (1 + before[1001][..., :3]) / 2
    np.testing.assert_allclose(found[..., :3], expected, atol=1.01 / 255)


@MODES
@DEPTHS
def test_such_images_are_projected_as_if_they_were_opaque(mode, is_float):
    above = values(2)
    shown = add_image("Above", above, is_float, mode)
    project(target="Made", width=SIDE, height=SIDE)
    found = image_pixels.read(bpy.data.images["Made"])
    assert (found[..., 3] == 1).all()
    colors = image_pixels.read(shown)[..., :3]
    expected = coded(colors) if is_float else colors
    np.testing.assert_allclose(found[..., :3], expected, atol=1.01 / 255)


@pytest.mark.parametrize("mode", ["CHANNEL_PACKED", "STRAIGHT"])
def test_materials_use_alpha_only_where_it_covers(square, mode):
    add_image("Above", values(1), False, mode)
    add_image("Below", values(2), False, mode)
    project(output="EXISTING", target="Below", create_material=True)
    tree = square.active_material.node_tree
    mix = next(node for node in tree.nodes if node.type == "MIX")
    factor = next(s for s in mix.inputs if s.identifier == "Factor_Float")
    assert factor.is_linked == (mode == "STRAIGHT")
    assert factor.is_linked or factor.default_value == 1
    project(mode="DECAL", create_material=True, decal_resolution=2)
    nodes = bpy.context.active_object.active_material.node_tree.nodes
    assert nodes["Principled BSDF"].inputs["Alpha"].is_linked == (mode == "STRAIGHT")
