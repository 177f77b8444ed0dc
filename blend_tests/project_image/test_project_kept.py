# SPDX-License-Identifier: GPL-3.0-or-later
"""What a projection leaves: pixels outlast saving, or a warning tells that they are not kept."""

import warnings

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.images import image_files, image_pixels
from limit_surface.project_image.colours import Encoding

SIZE = 16
UNSAVED = "The .blend file does not store the changed pixels of Old"
MULTIPLIED = Encoding(False, None, True, True)


def projected(pixel, **properties) -> None:
    """Projects an image of one color onto a sheet, and fades it in from its borders."""
    ob = bpy.data.objects.get("Holes") or scenes.grid_with_holes()
    if not ob.data.uv_layers:
        scenes.add_uv_map(ob, lambda at: 0.05 + 0.9 * at[:, :2] / (5, 4))
        scenes.add_subsurf(ob)
        empty = bpy.data.objects.new("Empty", None)
        bpy.context.collection.objects.link(empty)
        empty.location, empty.empty_display_size = (2.5, 2, 3), 2
        bpy.context.view_layer.update()
    shown = bpy.data.images.new("Shown", 8, 8, alpha=True, float_buffer=True)
    shown.pixels.foreach_set(np.tile(np.float32(pixel), 64))
    scenes.activate(ob)
    new = {"target": "New", "width": SIZE, "height": SIZE}
    if properties.get("output") == "EXISTING":
        new = {"target": "Old"}
    done = bpy.ops.object.limit_project_image(
        source="PLANAR", empty="Empty", image="Shown", soft_edge=0.3, **new | properties
    )
    assert done == {"FINISHED"}


def pixels(name: str) -> np.ndarray:
    return image_pixels.read(bpy.data.images[name])


def save_and_load(folder) -> None:
    path = str(folder / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)


def add_old(depth: str, source: str, folder) -> None:
    """Adds an image to paint into."""
    is_float = depth == "float"
    old = bpy.data.images.new("Old", SIZE, SIZE, alpha=True, float_buffer=is_float)
    old.pixels.foreach_set(np.tile(np.float32([0.2, 0.4, 0.2, 0.6]), SIZE * SIZE))
    old.use_fake_user = True
    if source == "packed":
        old.pack()
    if source == "file":
        kind = image_files.EXR_32 if is_float else image_files.PNG_8
        image_pixels.save(old, folder / f"old{kind.suffix}", kind)


@pytest.mark.parametrize("use_float", [False, True])
def test_new_images_outlast_saving(use_float, tmp_path):
    projected([0.9, 0.5, 0.1, 0.7], use_float=use_float)
    before = pixels("New")
    soft = (before[..., 3] > 0.01) & (before[..., 3] < 0.6)
    assert soft.sum() > 20
    save_and_load(tmp_path)
    np.testing.assert_array_equal(pixels("New"), before)


@pytest.mark.parametrize("source", ["generated", "packed"])
@pytest.mark.parametrize("depth", ["8", "float"])
def test_what_is_painted_into_an_image_of_the_file_outlasts_saving(depth, source, tmp_path, capfd):
    add_old(depth, source, tmp_path)
    projected([0.9, 0.5, 0.1, 0.7], output="EXISTING")
    assert UNSAVED not in capfd.readouterr().out
    before = pixels("Old")
    assert len(np.unique(before.reshape(-1, 4), axis=0)) > 20
    save_and_load(tmp_path)
    np.testing.assert_array_equal(pixels("Old"), before)


def test_a_warning_says_that_an_image_of_its_own_file_is_not_saved(tmp_path, capfd):
    add_old("8", "file", tmp_path)
    file = (tmp_path / "old.png").read_bytes()
    projected([0.9, 0.5, 0.1, 0.7], output="EXISTING")
    assert UNSAVED in capfd.readouterr().out
    assert (tmp_path / "old.png").read_bytes() == file
    bpy.data.images["Old"].save()
    assert (tmp_path / "old.png").read_bytes() != file


def test_a_warning_counts_the_faces_outside_the_image(capfd):
    projected([0.9, 0.5, 0.1, 0.7])
    assert "outside" not in capfd.readouterr().out
    layer = bpy.data.objects["Holes"].data.uv_layers[0]
    for corner in layer.data:
        corner.uv.x += 0.5
    projected([0.9, 0.5, 0.1, 0.7])
    assert "lie wholly or partly outside tile 1001 on the UV map" in capfd.readouterr().out


def test_all_colours_are_multiplied_by_alpha():
    alpha = np.float32([1, 0.5, 1e-3, 1e-6, 1e-7, 1e-20, 0])[:, None]
    straight = np.concatenate([np.full((7, 3), 0.5, np.float32), alpha], axis=1)
    multiplied = MULTIPLIED.encoded(straight)
    np.testing.assert_array_equal(multiplied[:, :3], np.repeat(0.5 * alpha, 3, axis=1))
    np.testing.assert_allclose(MULTIPLIED.decoded(multiplied)[:-1], straight[:-1], rtol=1e-6)


def test_infinite_colours_warn_of_nothing():
    values = np.full((5, 4), 0.5, np.float32)
    values[0, 0], values[1, 1], values[2, 2] = np.inf, np.nan, np.finfo(np.float32).max
    values[3, 3], values[4] = np.inf, np.inf
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_array_equal(MULTIPLIED.decoded(values)[0], [np.inf, 1, 1, 0.5])
        MULTIPLIED.encoded(MULTIPLIED.decoded(values))


def add_material(ob: bpy.types.Object, shader: str | None) -> None:
    material = bpy.data.materials.new("Own")
    material.use_nodes = True
    if shader:
        material.node_tree.nodes.clear()
        material.node_tree.nodes.new(shader)
    ob.data.materials.append(material)


@pytest.mark.parametrize(
    ("shaders", "active", "face", "unseen"),
    [
        ([None], 0, 0, ""),
        (["ShaderNodeEmission"], 0, 0, "New"),
        ([None, None], 1, 0, "Own.001"),
        ([None, None], 1, 1, ""),
        ([None, None], 1, 7, ""),  # beyond the last slot, which such faces have
        ([], 0, 0, ""),
    ],
)
def test_a_warning_names_a_material_that_no_face_has(shaders, active, face, unseen, capfd):
    ob = scenes.grid_with_holes()
    for shader in shaders:
        add_material(ob, shader)
    ob.active_material_index = active
    ob.data.polygons.foreach_set("material_index", [face] * len(ob.data.polygons))
    projected([0.9, 0.5, 0.1, 1], create_material=True)
    said = capfd.readouterr().out
    assert ("No face of Holes has the material" in said) == bool(unseen)
    assert f"No face of Holes has the material {unseen}" in said or not unseen
