# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/report.md: a mesh at two levels, in the colours that object.limit_report
gives it, on one scale."""

import tempfile
from pathlib import Path

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.report import colours
from PIL import Image

from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, INK, colour_bar, font, on_screen, row_of_panels, save

LEVELS = (1, 2)
PIXELS = (520, 430)
FULL = 0.015  # this distance is yellow


def make(folder: Path, samples: int = 32) -> None:
    scene.start()
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{level}.png" for level in LEVELS]
        found = [draw(level, part, samples) for level, part in zip(LEVELS, parts, strict=True)]
        save(composed(parts, found), folder / "report.png")


def draw(level: int, path: Path, samples: int) -> dict[str, float]:
    """Renders the mesh that is measured, with flat polygons, and returns the distances."""
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
    """Shows the attribute's colours, also where no light falls."""
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
    """The panels side by side, and the scale below."""
    titles = [f"Level {numbers['level']}" for numbers in found]
    row = row_of_panels([Image.open(part) for part in parts], titles, 100)
    sheet, pen, width = row.sheet, row.pen, row.sheet.width
    for middle, numbers in zip(row.middle, found, strict=True):
        said = f"at most {numbers['max']:.2g}, in the mean {numbers['mean']:.2g}"
        pen.text((middle, row.bottom + 6), said, INK, font(14), anchor="ma")
    bar = on_screen(colours.of_distances(np.linspace(0, FULL, 380), FULL)[:, :3])
    x, y = (width - len(bar)) // 2, row.bottom + 36
    sheet.paste(colour_bar(bar), (x, y))
    for value in (0, 0.005, 0.01, FULL):
        tick = x + len(bar) * value / FULL
        pen.line((tick, y + 14, tick, y + 19), fill=GREY)
        pen.text((tick, y + 21), f"{value:g}", INK, font(13), anchor="ma")
    said = "largest distance from the limit surface around each vertex of the cage"
    pen.text((width / 2, y + 39), said, GREY, font(13), anchor="ma")
    return sheet
