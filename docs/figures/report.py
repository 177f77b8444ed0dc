# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/report.md: a mesh at two levels, in the colours that object.limit_report
gives it, on one scale."""

import tempfile
from pathlib import Path

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.report import colours
from PIL import Image, ImageDraw

from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, INK, colour_bar, font, on_screen, save

LEVELS = (1, 2)
PIXELS = (520, 430)
GAP, TOP, BOTTOM = 14, 40, 100
FULL = 0.015  # distance that is yellow


def make(folder: Path, samples: int = 32) -> None:
    scene.start()
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{level}.png" for level in LEVELS]
        found = [draw(level, part, samples) for level, part in zip(LEVELS, parts, strict=True)]
        save(composed(parts, found), folder / "report.png")


def draw(level: int, path: Path, samples: int) -> dict[str, float]:
    """Renders what is measured: the mesh of the render's level, its polygons flat."""
    bpy.ops.mesh.primitive_monkey_add()
    ob = bpy.context.active_object
    ob.modifiers.new("Subdivision", "SUBSURF").render_levels = level
    ob.data.materials.append(material())
    bpy.ops.object.limit_report(levels="RENDER", full_color=FULL)
    scene.render(path, View(25, 12), np.array([0.12, 0, 0.02]), 2.85, PIXELS, samples)
    found = dict(ob[ids.REPORT]["RENDER"])
    bpy.data.batch_remove([ob, ob.data])
    return found


def material() -> bpy.types.Material:
    """The attribute's colours, as they are where no light falls and somewhat brighter elsewhere."""
    made = bpy.data.materials.get("Distance") or bpy.data.materials.new("Distance")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Specular IOR Level"].default_value = 0
    source = nodes.new("ShaderNodeVertexColor")
    source.layer_name = ids.DISTANCE_COLOR
    for socket in ("Base Color", "Emission Color"):
        links.new(source.outputs["Color"], shader.inputs[socket])
    shader.inputs["Emission Strength"].default_value = 0.45
    return made


def composed(parts: list[Path], found: list[dict[str, float]]) -> Image.Image:
    """Side by side, the scale below."""
    width = len(parts) * (PIXELS[0] + GAP) + GAP
    sheet = Image.new("RGB", (width, TOP + PIXELS[1] + BOTTOM), "white")
    pen = ImageDraw.Draw(sheet)
    for i, (part, numbers) in enumerate(zip(parts, found, strict=True)):
        left, picture = GAP + i * (PIXELS[0] + GAP), Image.open(part)
        sheet.paste(picture, (left, TOP), picture)
        middle, below = left + PIXELS[0] / 2, TOP + PIXELS[1]
        pen.text((middle, 10), f"Level {numbers['level']}", INK, font(17), anchor="ma")
        said = f"at most {numbers['max']:.2g}, in the mean {numbers['mean']:.2g}"
        pen.text((middle, below + 6), said, INK, font(14), anchor="ma")
    bar = on_screen(colours.of_distances(np.linspace(0, FULL, 380), FULL)[:, :3])
    x, y = (width - len(bar)) // 2, TOP + PIXELS[1] + 36
    sheet.paste(colour_bar(bar), (x, y))
    for value in (0, 0.005, 0.01, FULL):
        tick = x + len(bar) * value / FULL
        pen.line((tick, y + 14, tick, y + 19), fill=GREY)
        pen.text((tick, y + 21), f"{value:g}", INK, font(13), anchor="ma")
    said = "largest distance from the limit surface around each vertex of the cage"
    pen.text((width / 2, y + 39), said, GREY, font(13), anchor="ma")
    return sheet
