# SPDX-License-Identifier: Apache-2.0
"""Figure 1 of Lacewell and Burley (2007): hair on an open mesh's limit surface.

The control mesh is a cross of five faces whose twelve vertices are all extraordinary and on the
boundary. The picture shows it with its limit surface, then 20 x 20 and 70 x 70 strands of hair on
each face. tools/demo.sh runs this in the environment that it sets up.
"""

import math
import time
from collections.abc import Sequence
from pathlib import Path

import bpy
import limitsurf
import numpy as np
from mathutils import Vector

from figures.meshes import obj
from figures.rendering import scene as scenes
from figures.rendering.quiet import quiet

PROPORTION = 1500 / 560  # width to height of the picture
SPACING = 3.5  # between the three surfaces
TURN = math.radians(24)  # of each about its axis, so that every side is visible
LEVELS = 6  # of the drawn surface: 64 x 64 polygons a face
HAIRS = {20: 0.0035, 70: 0.0017}  # strands along each side of a face, and their radius
LENGTH = 0.26

SURFACE_BLUE = (0.055, 0.16, 0.50)
CAGE_GREEN = (0.02, 0.33, 0.06)
HAIR_BROWN = (0.42, 0.21, 0.08)


def make(folder: Path, samples: int = 32, width: int = 1500, keep_scene: bool = False) -> None:
    start = time.perf_counter()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    positions, faces = obj.read(obj.CROSS)
    print(f"{obj.CROSS.name}: {len(positions)} vertices, {len(faces)} faces")

    add_cage_and_surface(positions, faces, Vector((-SPACING, 0, 0)))
    for i, (per_side, radius) in enumerate(HAIRS.items()):
        add_hairy_surface(positions, faces, per_side, radius, Vector((i * SPACING, 0, 0)))
    set_up_picture(width, samples)

    folder.mkdir(parents=True, exist_ok=True)
    blend, picture = (folder / f"figure1.{kind}" for kind in ("blend", "png"))
    bpy.context.scene.render.filepath = str(picture)
    begin = time.perf_counter()
    with quiet():
        bpy.ops.render.render(write_still=True)
    print(f"{picture}: rendered in {time.perf_counter() - begin:.1f} s")
    if keep_scene:
        bpy.context.preferences.filepaths.save_version = 0  # no figure1.blend1
        bpy.ops.wm.save_as_mainfile(filepath=str(blend), compress=True)
        print(f"{blend}: {blend.stat().st_size / 2**20:.1f} MiB")
    print(f"All in {time.perf_counter() - start:.1f} s")


def add_mesh(
    name: str, positions: np.ndarray, faces: Sequence[Sequence[int]], at: Vector
) -> bpy.types.Object:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(positions, [], faces)
    ob = bpy.data.objects.new(name, mesh)
    ob.location = at
    ob.rotation_euler.z = TURN
    bpy.context.collection.objects.link(ob)
    return ob


def add_cage_and_surface(positions: np.ndarray, faces: list[list[int]], at: Vector) -> None:
    surface = limitsurf.LimitSurface(limitsurf.ControlMesh.from_faces(positions, faces))
    begin = time.perf_counter()
    polygons = surface.tessellate(LEVELS)
    print(
        f"Limit surface: {len(polygons.faces)} polygons, all vertices exact, "
        f"in {1e3 * (time.perf_counter() - begin):.1f} ms"
    )
    shown = add_mesh("Limit surface", polygons.positions, polygons.faces, at)
    shown.data.shade_smooth()
    shown.data.materials.append(material("Surface", SURFACE_BLUE, roughness=0.45))

    cage = add_mesh("Control mesh", positions, faces, at)
    wire = cage.modifiers.new("Wireframe", "WIREFRAME")
    wire.thickness, wire.use_even_offset, wire.use_boundary, wire.offset = 0.035, False, True, 0
    cage.visible_shadow = False
    cage.data.materials.append(material("Control mesh", CAGE_GREEN, roughness=0.5))
    for i, position in enumerate(positions):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.055, location=position)
        ball = bpy.context.active_object
        ball.parent = cage
        ball.visible_shadow = False
        ball.name = f"Control vertex {i}"
        ball.data.shade_smooth()
        ball.data.materials.append(cage.data.materials[0])


def add_hairy_surface(
    positions: np.ndarray, faces: list[list[int]], per_side: int, radius: float, at: Vector
) -> None:
    """A cross that Blender subdivides itself, and hair by the add-on's operator."""
    cross = add_mesh(f"Cross {per_side}", positions, faces, at)
    cross.data.shade_smooth()
    cross.data.materials.append(bpy.data.materials["Surface"])
    subsurf = cross.modifiers.new("Subdivision", "SUBSURF")
    subsurf.levels = subsurf.render_levels = LEVELS
    subsurf.quality = 10

    bpy.context.view_layer.objects.active = cross
    begin = time.perf_counter()
    bpy.ops.object.limit_hair_add(per_side=per_side, length=LENGTH, points=4, radius=radius, seed=1)
    hair = bpy.context.active_object
    print(
        f"{hair.name}: {len(hair.data.curves)} strands, {per_side} x {per_side} a face, "
        f"in {1e3 * (time.perf_counter() - begin):.1f} ms"
    )
    hair.data.materials.append(material("Hair", HAIR_BROWN, roughness=0.6))


def material(name: str, colour: tuple[float, float, float], roughness: float) -> bpy.types.Material:
    return scenes.material(name, colour, glow=0, roughness=roughness)


def set_up_picture(width: int, samples: int) -> None:
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.seed = 0
    scene.render.resolution_x, scene.render.resolution_y = width, round(width / PROPORTION)
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = False
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.compression = 90
    scene.view_settings.view_transform = "Standard"

    add_camera(scene)
    add_light("Key", location=(-6, -8, 10), energy=1500, size=3)
    add_light("Rim", location=(7, 6, 8), energy=500, size=4)
    scene.world = white_paper()


def white_paper() -> bpy.types.World:
    """A world that is white to the camera, and a dimmer sky for everything else."""
    world = bpy.data.worlds.new("Paper")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    sight, strength = nodes.new("ShaderNodeLightPath"), nodes.new("ShaderNodeMapRange")
    strength.inputs["To Min"].default_value = 0.35
    links.new(sight.outputs["Is Camera Ray"], strength.inputs["Value"])
    nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    links.new(strength.outputs["Result"], nodes["Background"].inputs["Strength"])
    return world


def add_camera(scene: bpy.types.Scene) -> None:
    """An orthographic camera that looks down at the middle one, so that all three look alike."""
    camera = bpy.data.cameras.new("Camera")
    camera.type = "ORTHO"
    camera.ortho_scale = 3 * SPACING
    ob = bpy.data.objects.new("Camera", camera)
    slope = math.radians(63)
    ob.location = Vector((0, -12 * math.cos(slope), 0.17 + 12 * math.sin(slope)))
    ob.rotation_euler = (math.radians(90) - slope, 0, 0)
    scene.collection.objects.link(ob)
    scene.camera = ob


def add_light(name: str, location: tuple[float, float, float], energy: float, size: float) -> None:
    light = bpy.data.lights.new(name, "AREA")
    light.energy, light.size = energy, size
    ob = bpy.data.objects.new(name, light)
    ob.location = location
    ob.rotation_euler = Vector(location).to_track_quat("Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(ob)
