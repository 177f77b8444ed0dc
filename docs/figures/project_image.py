# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/project_image.md: an image projected from a camera onto an open mesh, seen
through that camera and from the side, and a decal."""

import tempfile
from pathlib import Path

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.reading import attributes
from mathutils import Vector
from PIL import Image

from figures.meshes.shapes import fan
from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, on_screen, row_of_panels, save

SECTORS, SIDE = 5, 4
HOLES = (13, 21)  # faces that are missing
TEXELS = 1024
IMAGE = 512
SQUARES = 8
EYE, AIM, LENS = (0.9, -5.4, 4.3), (0.1, -0.1, 0.3), 33.0
SIDE_VIEW, SIDE_TARGET, SIDE_WIDTH = View(58, 22), np.array([0.75, -1.0, 1.2]), 8.8
CLOSE_VIEW, CLOSE_TARGET, CLOSE_WIDTH = View(38, 42), np.array([0.3, -0.05, 0.4]), 7.0
PIXELS = (440, 400)
RED, CREAM, BLUE = (0.70, 0.16, 0.10), (0.95, 0.90, 0.78), (0.10, 0.25, 0.50)
CLAY = (0.55, 0.53, 0.50)
PANELS = ("Through the camera", "From the side", "A decal")


def make(folder: Path, samples: int = 32) -> None:
    scene.start()
    sheet, camera = add_sheet(), add_camera()
    checker_image(), sticker_image()
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{i}.png" for i in range(len(PANELS))]
        paint(sheet, camera, "Checker")
        scene.render_through(camera, parts[0], PIXELS, samples)
        rays = add_camera_rays(camera)
        scene.render(parts[1], SIDE_VIEW, SIDE_TARGET, SIDE_WIDTH, PIXELS, samples)
        rays.hide_render = True
        sheet.data.materials[0] = material("Clay", None)
        add_decal(sheet, camera)
        scene.render(parts[2], CLOSE_VIEW, CLOSE_TARGET, CLOSE_WIDTH, PIXELS, samples)
        save(composed(parts), folder / "project_image.png")


def add_sheet() -> bpy.types.Object:
    """A sheet around a pole of five faces, with holes and a hump that hides what is behind it."""

    def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return 1.9 * np.exp(-1.1 * ((x - 0.5) ** 2 + (y + 0.3) ** 2)) + 0.3 * np.sin(
            0.8 * x + 0.5 * y
        )

    positions, faces = fan(SECTORS, SIDE, 2 * np.pi, height)
    positions = positions * [0.8, 0.8, 1]
    kept = [face for i, face in enumerate(faces) if i not in HOLES]
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(positions.tolist(), [], kept)
    mesh.shade_smooth()
    layer = mesh.uv_layers.new(name="Map")
    plan = attributes.read(mesh, ids.POSITION)[attributes.read(mesh, ids.CORNER_VERTEX), :2]
    layer.data.foreach_set("uv", (0.5 + plan / np.ptp(plan) * 0.96).astype(np.float32).ravel())
    ob = bpy.data.objects.new("Sheet", mesh)
    bpy.context.collection.objects.link(ob)
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.render_levels, subsurf.quality = 5, 6
    return ob


def add_camera() -> bpy.types.Object:
    camera = bpy.data.cameras.new("Projector")
    camera.lens, camera.shift_x = LENS, 0.02
    ob = bpy.data.objects.new("Projector", camera)
    ob.location = EYE
    ob.rotation_euler = (Vector(AIM) - Vector(EYE)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    return ob


def checker_image() -> bpy.types.Image:
    y, x = np.mgrid[:IMAGE, :IMAGE] * SQUARES // IMAGE
    colors = np.where(((x + y) % 2 == 1)[..., None], RED, CREAM)
    return add_image("Checker", colors, np.ones((IMAGE, IMAGE)))


def sticker_image() -> bpy.types.Image:
    """Rings and a star, transparent around them."""
    y, x = (np.mgrid[:IMAGE, :IMAGE] + 0.5) * 2 / IMAGE - 1
    radius, angle = np.hypot(x, y), np.arctan2(x, y)
    sharp = 0.5 * IMAGE
    star = 0.30 + 0.16 * np.abs((angle * 5 / np.pi + 1) % 2 - 1) ** 1.3 * 2
    colors = np.broadcast_to(CREAM, (IMAGE, IMAGE, 3))
    for edge, color in ((0.90, BLUE), (0.74, CREAM), (star, RED)):
        share = np.clip((edge - radius) * sharp + 0.5, 0, 1)[..., None]
        colors = colors * (1 - share) + share * np.array(color)
    return add_image("Sticker", colors, np.clip((0.98 - radius) * sharp + 0.5, 0, 1))


def add_image(name: str, colors: np.ndarray, alpha: np.ndarray) -> bpy.types.Image:
    """`colors` are amounts of light."""
    image = bpy.data.images.new(name, IMAGE, IMAGE, alpha=True)
    image.pixels.foreach_set(np.dstack([on_screen(colors), alpha]).astype(np.float32).ravel())
    return image


def paint(sheet: bpy.types.Object, camera: bpy.types.Object, image: str) -> bpy.types.Image:
    """Projects the image onto a texture of clay."""
    target = bpy.data.images.new("Texture", TEXELS, TEXELS, alpha=True)
    target.pixels.foreach_set(np.tile(np.float32([*on_screen(np.array(CLAY)), 1]), TEXELS**2))
    select(sheet)
    bpy.ops.object.limit_project_image(
        source="CAMERA", image=image, camera=camera.name, output="EXISTING", target=target.name
    )
    sheet.data.materials.append(material("Painted", target))
    return target


def add_decal(sheet: bpy.types.Object, camera: bpy.types.Object) -> None:
    select(sheet)
    camera.data.lens = 2 * LENS
    bpy.ops.object.limit_project_image(
        mode="DECAL",
        source="CAMERA",
        image="Sticker",
        camera=camera.name,
        decal_resolution=160,
        decal_offset=0.008,
    )
    bpy.context.active_object.data.materials.append(
        material("Sticker", bpy.data.images["Sticker"], with_alpha=True)
    )


def select(ob: bpy.types.Object) -> None:
    bpy.context.view_layer.objects.active = ob


def material(
    name: str, image: bpy.types.Image | None, with_alpha: bool = False
) -> bpy.types.Material:
    """Shows the image, or clay, also where no light falls."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Roughness"].default_value = 0.6
    shader.inputs["Specular IOR Level"].default_value = 0.2
    shader.inputs["Emission Strength"].default_value = 0.25
    if image is None:
        for socket in ("Base Color", "Emission Color"):
            shader.inputs[socket].default_value = (*CLAY, 1)
        return made
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    for socket in ("Base Color", "Emission Color"):
        links.new(texture.outputs["Color"], shader.inputs[socket])
    if with_alpha:
        links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
    return made


def add_camera_rays(camera: bpy.types.Object) -> bpy.types.Object:
    """The camera's frame, and lines from its eye through the frame's corners."""
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = IMAGE, IMAGE
    frame = np.array(camera.data.view_frame(scene=bpy.context.scene))
    matrix = np.array(camera.matrix_world)
    corners = (1.6 * frame) @ matrix[:3, :3].T + matrix[:3, 3]
    eye = np.broadcast_to(matrix[:3, 3], corners.shape)
    ends = [np.stack([eye, corners], axis=1), np.stack([corners, np.roll(corners, 1, 0)], axis=1)]
    scene.add_lines("Frustum", ends, 0.018, scene.CAGE_BLUE)
    return bpy.data.objects["Frustum"]


def composed(parts: list[Path]) -> Image.Image:
    row = row_of_panels([Image.open(part) for part in parts], PANELS, 14)
    for left in row.left:
        top = row.bottom - PIXELS[1]
        row.pen.rectangle((left, top, left + PIXELS[0] - 1, row.bottom - 1), outline=GREY)
    return row.sheet
