# SPDX-License-Identifier: Apache-2.0
"""Surfaces, lines, materials and cameras in Blender.

Nothing here is left to chance: suns without a size and no bounces make pictures without noise.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from limit_surface.reading import attributes
from mathutils import Euler, Vector

from figures.rendering.quiet import quiet

COLOUR = "colour"
INK = (0.01, 0.01, 0.015)
GREY = (0.3, 0.28, 0.2)
CAGE_BLUE = (0.02, 0.10, 0.35)
#: The radius of lines, relative to the width of the picture
RADIUS = 0.0018

#: The directions to the lights in the camera's axes (right, up, towards it), and their strengths
SUNS = (((-0.7, 0.6, 0.4), 2.2), ((0.5, 0.1, 0.9), 1.0))
GLOW = 0.12  # how bright a colour is where no light falls


@dataclass(frozen=True)
class View:
    """Where the camera stands: degrees around z from -y on, degrees above the horizon."""

    turn: float
    height: float


def start() -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 0
    scene.cycles.seed = 0
    scene.cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    scene.cycles_curves.shape = "THICK"
    scene.render.dither_intensity = 0
    scene.render.film_transparent = True
    scene.render.resolution_percentage = 100
    scene.render.image_settings.color_mode = "RGBA"
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("Dark")
    scene.world.color = (0, 0, 0)


def add_surface(quads: np.ndarray, positions: np.ndarray, colours: np.ndarray) -> None:
    """Adds the mesh of quads (n, 4); every vertex has a position and a colour."""
    used, corners = np.unique(quads, return_inverse=True)
    mesh = bpy.data.meshes.new("Surface")
    mesh.vertices.add(len(used))
    mesh.loops.add(quads.size)
    mesh.polygons.add(len(quads))
    attributes.write(mesh, "position", "FLOAT_VECTOR", "POINT", positions[used])
    mesh.polygons.foreach_set("loop_start", np.arange(0, quads.size, 4, dtype=np.int32))
    mesh.loops.foreach_set("vertex_index", corners.ravel().astype(np.int32))
    mesh.update(calc_edges=True)
    rgba = np.column_stack([colours[used], np.ones(len(used))]).astype(np.float32)
    layer = mesh.color_attributes.new(COLOUR, "FLOAT_COLOR", "POINT")
    layer.data.foreach_set("color", rgba.ravel())
    mesh.shade_smooth()
    mesh.materials.append(_material("Surface", None))
    bpy.context.collection.objects.link(bpy.data.objects.new("Surface", mesh))


def add_lines(
    name: str, lines: Sequence[np.ndarray], radius: float, colour: Sequence[float]
) -> None:
    """Adds tubes along lines, which are given as arrays (lines, points, 3)."""
    curves = bpy.data.hair_curves.new(name)
    curves.add_curves([some.shape[1] for some in lines for _ in range(len(some))])
    points = np.concatenate([some.reshape(-1, 3) for some in lines])
    curves.points.foreach_set("position", points.astype(np.float32).ravel())
    attributes.write(curves, "radius", "FLOAT", "POINT", np.full(len(points), radius))
    curves.materials.append(_material(name, colour))
    ob = bpy.data.objects.new(name, curves)
    ob.visible_shadow = False
    bpy.context.collection.objects.link(ob)


def _material(name: str, colour: Sequence[float] | None) -> bpy.types.Material:
    """A material of one colour that no light changes, or else of the vertices' lit colours."""
    found = bpy.data.materials.get(name)
    if found:
        return found
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Roughness"].default_value = 0.55
    shader.inputs["Specular IOR Level"].default_value = 0.25
    if colour is not None:
        shader.inputs["Base Color"].default_value = (0, 0, 0, 1)
        shader.inputs["Specular IOR Level"].default_value = 0
        shader.inputs["Emission Color"].default_value = (*colour, 1)
        shader.inputs["Emission Strength"].default_value = 1
        return made
    source = nodes.new("ShaderNodeVertexColor")
    source.layer_name = COLOUR
    for socket in ("Base Color", "Emission Color"):
        links.new(source.outputs["Color"], shader.inputs[socket])
    shader.inputs["Emission Strength"].default_value = GLOW
    return made


def material(
    name: str,
    colour: Sequence[float],
    glow: float,
    roughness: float = 0.5,
    specular: float = 0.5,
) -> bpy.types.Material:
    """A material of one colour, which `glow` shows where no light falls."""
    made = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    for socket, value in (
        ("Base Color", (*colour, 1)),
        ("Roughness", roughness),
        ("Specular IOR Level", specular),
        ("Emission Color", (*colour, 1)),
        ("Emission Strength", glow),
    ):
        shader.inputs[socket].default_value = value
    return made


def render(
    path: Path, view: View, target: np.ndarray, width: float, pixels: tuple[int, int], samples: int
) -> None:
    """Renders through an orthographic camera that sees this width of the scene."""
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("Camera")
    camera.type, camera.ortho_scale, camera.sensor_fit = "ORTHO", width, "HORIZONTAL"
    camera.clip_end = 1000
    ob = bpy.data.objects.new("Camera", camera)
    ob.rotation_euler = _turned(view)
    ob.location = Vector(target) + ob.rotation_euler.to_matrix() @ Vector((0, 0, 50))
    scene.collection.objects.link(ob)
    bpy.context.view_layer.update()
    render_through(ob, path, pixels, samples)
    bpy.data.cameras.remove(camera)


def render_through(
    camera: bpy.types.Object, path: Path, pixels: tuple[int, int], samples: int
) -> None:
    """Renders with lights that have the same directions relative to every camera."""
    scene = bpy.context.scene
    scene.camera = camera
    turned = camera.matrix_world.to_3x3().normalized()
    for direction, strength in SUNS:
        sun = bpy.data.lights.new("Sun", "SUN")
        sun.energy, sun.angle = strength, 0
        lamp = bpy.data.objects.new("Sun", sun)
        lamp.rotation_euler = (turned @ Vector(direction)).to_track_quat("Z", "Y").to_euler()
        scene.collection.objects.link(lamp)
    scene.cycles.samples = samples
    scene.render.resolution_x, scene.render.resolution_y = pixels
    scene.render.filepath = str(path)
    with quiet():
        bpy.ops.render.render(write_still=True)
    for light in list(bpy.data.lights):
        bpy.data.lights.remove(light)


def axes(view: View) -> np.ndarray:
    """Directions to the right, up and towards the camera, as columns."""
    return np.array(_turned(view).to_matrix())


def _turned(view: View) -> Euler:
    return Euler(np.radians([90 - view.height, 0, view.turn]))


def clear() -> None:
    """Removes what `add_surface` and `add_lines` have added."""
    for ob in [some for some in bpy.context.scene.objects if not some.hide_render]:
        bpy.data.batch_remove([ob.data, ob])
