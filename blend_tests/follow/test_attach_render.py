# SPDX-License-Identifier: GPL-3.0-or-later
"""An attached object in a rendered animation."""

import bpy
import numpy as np
import scenes
from follow_scenes import deforming
from test_attach import add_object, attach, matrices

SIZE, SCALE = 64, 6.0  # pixels, and the width that they show
FRAMES = (1, 15, 30)


def glowing_ball() -> bpy.types.Object:
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.3)
    ball = bpy.context.active_object
    material = bpy.data.materials.new("Glow")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    glow, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    links.new(glow.outputs[0], output.inputs["Surface"])
    ball.data.materials.append(material)
    return ball


def watch_from_above(folder) -> None:
    camera = add_object("Eye", bpy.data.cameras.new("Eye"), np.eye(4))
    camera.location = (0, 0, 20)
    camera.data.type, camera.data.ortho_scale = "ORTHO", SCALE
    scene = bpy.context.scene
    scene.camera = camera
    render = scene.render
    render.engine, scene.cycles.samples, scene.cycles.device = "CYCLES", 4, "CPU"
    render.resolution_x = render.resolution_y = SIZE
    render.film_transparent = True
    render.image_settings.file_format, render.image_settings.color_mode = "PNG", "RGBA"
    render.filepath = str(folder / "frame")
    scene.frame_start, scene.frame_end, scene.frame_step = FRAMES[0], FRAMES[-1], 1
    scene.frame_step = FRAMES[1] - FRAMES[0]


def centre(path) -> np.ndarray:
    """Returns the centre of what covers the picture, in world units."""
    image = bpy.data.images.load(str(path))
    alpha = np.empty(4 * SIZE * SIZE, np.float32)
    image.pixels.foreach_get(alpha)
    alpha = alpha.reshape(SIZE, SIZE, 4)[:, :, 3].astype(np.float64)
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    found = np.array([(x * alpha).sum(), (y * alpha).sum()]) / alpha.sum()
    return (found / SIZE - 0.5) * SCALE


def test_it_moves_in_cycles(tmp_path):
    ob = deforming("cross")
    ob.hide_render = True
    ball = glowing_ball()
    ball.location = scenes.transformed(ob.matrix_world, np.array([[0.9, 0.1, 0.3]]))[0]
    bpy.context.view_layer.update()
    attach(ob, [ball])
    watch_from_above(tmp_path)
    bpy.ops.render.render(animation=True)
    seen = []
    for frame in range(FRAMES[0], FRAMES[-1] + 1, FRAMES[1] - FRAMES[0]):
        bpy.context.scene.frame_set(frame)
        found = centre(tmp_path / f"frame{frame:04}.png")
        expected = matrices([ball])[0, :2, 3]
        np.testing.assert_allclose(found, expected, atol=0.2 * SCALE / SIZE)
        seen.append(found)
    assert np.linalg.norm(seen[-1] - seen[0]) > 3 * SCALE / SIZE
