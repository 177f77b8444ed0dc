# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/bake_maps.md: a control mesh that is shaded by a baked normal map, beside the
limit surface; and baked maps, on the surface and flat."""

import tempfile
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
from PIL import Image, ImageDraw

from figures.rendering import scene
from figures.rendering.quiet import quiet
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, INK, font, save

TEXELS = 512
VIEW, TARGET, WIDTH = View(24, 12), np.array([0.05, 0.0, -0.02]), 2.95
LARGE, SMALL = (420, 320), (205, 160)
FINE = 4  # levels of the mesh that is shown as the limit surface
GAP, TOP, BOTTOM = 10, 34, 40
PAPER = (226, 226, 222)
CLAY = (0.55, 0.5, 0.42)

#: The maps that are shown: their names in object.limit_bake_maps, and those of their images
MAPS = (
    ("NORMAL_TANGENT", "Tangent Normal"),
    ("NORMAL_OBJECT", "Normal"),
    ("POSITION", "Position"),
    ("CURVATURE_MEAN", "Mean Curvature"),
    ("CAVITY", "Cavity"),
    ("AREA_DISTORTION", "Distortion"),
)
SHADED = (
    "control mesh: 500 polygons",
    "control mesh with its normal map",
    "the limit surface itself",
)


def make(folder: Path, samples: int = 32) -> None:
    scene.start()
    head = bake()
    with tempfile.TemporaryDirectory() as parts:
        shaded = [Path(parts) / f"shaded{i}.png" for i in range(3)]
        for path, (levels, with_map) in zip(
            shaded, ((0, False), (0, True), (FINE, False)), strict=True
        ):
            material(head, lambda nodes, with_map=with_map: clay(nodes, with_map))
            draw(head, levels, path, LARGE, samples)
        on_surface = []
        for _, name in MAPS:
            on_surface.append(Path(parts) / f"{name}.png")
            material(head, lambda nodes, name=name: emission(nodes, image_of(name)))
            draw(head, 0 if name == "Tangent Normal" else 3, on_surface[-1], SMALL, samples)
        save(composed(shaded, on_surface), folder / "bake_maps.png")


def bake() -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    head = bpy.context.active_object
    head.name = "Head"
    head.data.shade_smooth()
    subsurf = head.modifiers.new("Subdivision", "SUBSURF")
    subsurf.quality = 8
    with quiet():
        bpy.ops.object.limit_bake_maps(
            maps={key for key, _ in MAPS},
            width=TEXELS,
            height=TEXELS,
            format="PNG_8",
            overlap="ALLOW",
            curvature_range=8,
            cavity_radius=0.06,
            distortion_range=3,
        )
    return head


def image_of(name: str) -> bpy.types.Image:
    return bpy.data.images[f"Head {name}"]


def material(ob: bpy.types.Object, build: Callable[[bpy.types.ShaderNodeTree], None]) -> None:
    made = bpy.data.materials.new("Shown")
    made.use_nodes = True
    made.node_tree.nodes.clear()
    build(made.node_tree)
    ob.data.materials.clear()
    ob.data.materials.append(made)


def clay(tree: bpy.types.ShaderNodeTree, with_map: bool) -> None:
    shader, output = add(tree, "BsdfPrincipled"), add(tree, "OutputMaterial")
    shader.inputs["Base Color"].default_value = (*CLAY, 1)
    shader.inputs["Roughness"].default_value = 0.45
    tree.links.new(shader.outputs[0], output.inputs[0])
    if with_map:
        texture, normal = add(tree, "TexImage"), add(tree, "NormalMap")
        texture.image = image_of("Tangent Normal")
        texture.image.colorspace_settings.name = "Non-Color"
        tree.links.new(texture.outputs[0], normal.inputs["Color"])
        tree.links.new(normal.outputs[0], shader.inputs["Normal"])


def emission(tree: bpy.types.ShaderNodeTree, image: bpy.types.Image) -> None:
    """Shows the numbers of the image's file unchanged on screen."""
    texture, shader, output = (
        add(tree, kind) for kind in ("TexImage", "Emission", "OutputMaterial")
    )
    texture.image = image
    image.colorspace_settings.name = "sRGB"
    tree.links.new(texture.outputs[0], shader.inputs[0])
    tree.links.new(shader.outputs[0], output.inputs[0])


def add(tree: bpy.types.ShaderNodeTree, kind: str) -> bpy.types.Node:
    return tree.nodes.new(f"ShaderNode{kind}")


def draw(
    head: bpy.types.Object, levels: int, path: Path, pixels: tuple[int, int], samples: int
) -> None:
    subsurf = head.modifiers[0]
    subsurf.show_render, subsurf.render_levels = levels > 0, levels
    scene.render(path, VIEW, TARGET, WIDTH, pixels, samples)


def composed(shaded: list[Path], on_surface: list[Path]) -> Image.Image:
    """Three large panels above; below each map on the surface and flat."""
    width = max(3 * (LARGE[0] + GAP), len(MAPS) * (SMALL[0] + GAP)) + GAP
    flat = SMALL[0]
    second = TOP + LARGE[1] + TOP
    picture = Image.new("RGB", (width, second + SMALL[1] + flat + BOTTOM), PAPER)
    pen = ImageDraw.Draw(picture)
    for i, (path, title) in enumerate(zip(shaded, SHADED, strict=True)):
        left = (2 * i + 1) * width // 6 - LARGE[0] // 2
        paste(picture, path, (left, TOP))
        pen.text((left + LARGE[0] / 2, 8), title, INK, font(17), anchor="ma")
    for i, (path, (_, name)) in enumerate(zip(on_surface, MAPS, strict=True)):
        left = GAP + i * (SMALL[0] + GAP)
        pen.text((left + SMALL[0] / 2, second - 24), name, INK, font(15), anchor="ma")
        paste(picture, path, (left, second))
        picture.paste(thumbnail(name, flat), (left, second + SMALL[1] + 6))
    said = (
        "each map on the surface (the tangent normals on the control mesh), and as the image it is"
    )
    pen.text((width / 2, picture.height - 24), said, GREY, font(13), anchor="ma")
    return picture


def paste(picture: Image.Image, path: Path, at: tuple[int, int]) -> None:
    panel = Image.open(path)
    picture.paste(panel, at, panel)


def thumbnail(name: str, side: int) -> Image.Image:
    pixels = np.empty(TEXELS * TEXELS * 4, np.float32)
    image_of(name).pixels.foreach_get(pixels)
    pixels = np.uint8(np.rint(255 * pixels.reshape(TEXELS, TEXELS, 4)[::-1]))
    whole = Image.new("RGB", (TEXELS, TEXELS), (40, 40, 44))
    shown = Image.fromarray(pixels)
    whole.paste(shown, (0, 0), shown)
    return whole.resize((side, side), Image.Resampling.BOX)
