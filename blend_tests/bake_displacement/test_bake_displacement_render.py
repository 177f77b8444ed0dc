# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes are rendered with the material that is made, and compared with the sculpted mesh: Cycles
returns where each ray of a picture meets the displaced surface.
"""

from pathlib import Path

import bpy
import numpy as np
import pytest
import scenes
import sculpts
from figures.rendering.quiet import quiet
from limit_surface.images import image_pixels

PIXELS = (96, 72)
LEVELS = {"Holes": 5, "Sculpt": 3}


@pytest.fixture
def both(tmp_path):
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob).uv_smooth = "SMOOTH_ALL"
    scenes.add_uv_map(ob, lambda at: at[:, :2] * [0.17, 0.19] + 0.07)
    sculpt = sculpts.reshape(sculpts.subdivided_copy(ob, 2), sculpts.ripples)
    for each in (ob, sculpt):
        each.modifiers[0].quality, each.modifiers[0].render_levels = 8, LEVELS[each.name]
    _set_scene(tmp_path / "seen.exr")
    return ob, sculpt


def _set_scene(path: Path) -> None:
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 1, False, 0
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.film_transparent = True
    scene.render.resolution_x, scene.render.resolution_y = PIXELS
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
    scene.render.filepath = str(path)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 6.2
    camera.location, camera.rotation_euler = (2.5, 1.0, 10), (0.1, 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera


def seen(ob) -> np.ndarray:
    """Returns (height, width, 4): the points where rays meet the mesh, and whether they do."""
    for other in bpy.context.scene.objects:
        other.hide_render = other.type == "MESH" and other != ob
    if not ob.data.materials:
        ob.data.materials.append(bpy.data.materials.new("Plain"))
    material = ob.active_material
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    where, light = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeEmission")
    links.new(where.outputs["Position"], light.inputs["Color"])
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    links.new(light.outputs["Emission"], output.inputs["Surface"])
    with quiet():
        bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(bpy.context.scene.render.filepath, check_existing=False)
    image.colorspace_settings.name = "Non-Color"
    found = image_pixels.read(image).copy()
    bpy.data.images.remove(image)
    return found


def apart(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Returns the distance between the two points of each ray that meets both meshes."""
    met = (one[..., 3] > 0.99) & (other[..., 3] > 0.99)
    assert met.sum() > 3000
    return np.linalg.norm(one[met][:, :3] - other[met][:, :3], axis=1)


@pytest.mark.parametrize(
    ("properties", "median", "most"),
    [({}, 3e-4, 2e-3), ({"space": "OBJECT"}, 3e-5, 1e-3), ({"mode": "SCALAR"}, 1e-4, 2e-3)],
)
def test_renders_show_the_sculpt(both, properties, median, most):
    ob, sculpt = both
    target = seen(sculpt)
    assert np.median(apart(seen(ob), target)) > 0.03
    ob.data.materials.clear()
    scenes.activate(ob)
    bpy.ops.object.limit_bake_displacement(
        target="Sculpt", width=512, height=512, create_material=True, **properties
    )
    distance = apart(seen(ob), target)
    assert np.median(distance) < median
    assert np.quantile(distance, 0.98) < most


def test_the_material_is_the_active_one_where_there_is_one(both):
    ob, sculpt = both
    own = bpy.data.materials.new("Own")
    own.use_nodes = True
    ob.data.materials.append(own)
    scenes.activate(ob)
    bpy.ops.object.limit_bake_displacement(
        target=sculpt.name, width=32, height=32, create_material=True
    )
    assert ob.active_material == own
    assert len(ob.material_slots) == 1
    assert own.displacement_method == "DISPLACEMENT"
    (node,) = (n for n in own.node_tree.nodes if n.type == "VECTOR_DISPLACEMENT")
    assert node.space == "TANGENT"
    assert node.inputs["Midlevel"].default_value == 0
    assert node.inputs["Scale"].default_value == 1
    image = node.inputs["Vector"].links[0].from_node.image
    assert image == bpy.data.images["Holes Displacement"]


@pytest.mark.parametrize("mode", ["VECTOR", "SCALAR"])
def test_the_same_nodes_show_the_next_bake(both, mode):
    """Artists bake again after each change of the sculpt."""
    ob, sculpt = both
    scenes.activate(ob)
    ob.data.materials.clear()
    order = {"target": sculpt.name, "width": 32, "height": 32, "create_material": True}
    bpy.ops.object.limit_bake_displacement(**order)
    nodes = ob.active_material.node_tree.nodes
    count = len(nodes)
    (node,) = (n for n in nodes if n.type == "VECTOR_DISPLACEMENT")
    node.inputs["Scale"].default_value = 0.5  # which the user may change
    scenes.add_uv_map(ob, lambda p: 0.9 * p[:, :2] / 5)  # it becomes Flat.001
    bpy.ops.object.limit_bake_displacement(mode=mode, space="OBJECT", uv_map="Flat.001", **order)
    assert len(nodes) == count
    assert len(ob.material_slots) == 1
    kind = "VECTOR_DISPLACEMENT" if mode == "VECTOR" else "DISPLACEMENT"
    (node,) = (n for n in nodes if n.type in ("VECTOR_DISPLACEMENT", "DISPLACEMENT"))
    assert (node.type, node.space) == (kind, "OBJECT")
    assert node.inputs["Scale"].default_value == (0.5 if mode == "VECTOR" else 1)
    texture = node.inputs[0].links[0].from_node
    assert texture.image == bpy.data.images["Holes Displacement"]
    assert texture.inputs["Vector"].links[0].from_node.uv_map == "Flat.001"


def test_tangents_of_another_map_are_warned_of(both, capfd):
    ob, sculpt = both
    scenes.activate(ob)
    ob.data.uv_layers.new(name="Other")
    ob.data.uv_layers["Other"].active_render = True
    bpy.ops.object.limit_bake_displacement(
        target=sculpt.name, width=32, height=32, uv_map="Flat", create_material=True
    )
    assert "Renders take tangents from the UV map Other: make Flat" in capfd.readouterr().out


def test_a_material_that_no_face_has_is_warned_of(both, capfd):
    ob, sculpt = both
    plain = bpy.data.materials.new("Plain")
    if plain.node_tree:  # from Blender 5.0 on
        plain.node_tree.nodes.clear()
    ob.data.materials.append(plain)
    scenes.activate(ob)
    bpy.ops.object.limit_bake_displacement(
        target=sculpt.name, width=32, height=32, create_material=True
    )
    assert "No face of Holes has the material Holes Displacement" in capfd.readouterr().out
