#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/report.md: a mesh at two levels, in the colours that object.limit_report
gives it, on one scale."""

import argparse
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "addon"))

import bpy  # noqa: E402
import exactness_scene as scene  # noqa: E402
import limit_surface  # noqa: E402
import numpy as np  # noqa: E402
from exactness_sheet import GREY, INK, font  # noqa: E402
from exactness_zoo import View  # noqa: E402
from limit_surface import ids  # noqa: E402
from limit_surface.report import colours  # noqa: E402
from PIL import Image, ImageDraw  # noqa: E402

LEVELS = (1, 2)
PIXELS = (520, 430)
GAP, TOP, BOTTOM = 14, 40, 100
FULL = 0.015  # distance that is yellow


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=ROOT / "docs/images/report.png")
    parser.add_argument("--samples", type=int, default=32, help="per pixel")
    arguments = parser.parse_args()
    limit_surface.register()
    scene.start()
    with tempfile.TemporaryDirectory() as folder:
        parts = [Path(folder) / f"{level}.png" for level in LEVELS]
        found = [
            draw(level, part, arguments.samples) for level, part in zip(LEVELS, parts, strict=True)
        ]
        compose(parts, found, arguments.output)
    limit_surface.unregister()


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


def compose(parts: list[Path], found: list[dict[str, float]], output: Path) -> None:
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
    bar = colours.of_distances(np.linspace(0, FULL, 380), FULL)[:, :3]
    screen = np.where(bar <= 0.0031308, 12.92 * bar, 1.055 * bar ** (1 / 2.4) - 0.055)
    x, y = (width - len(bar)) // 2, TOP + PIXELS[1] + 36
    sheet.paste(Image.fromarray(np.tile(np.uint8(np.rint(255 * screen)), (14, 1, 1))), (x, y))
    for value in (0, 0.005, 0.01, FULL):
        tick = x + len(bar) * value / FULL
        pen.line((tick, y + 14, tick, y + 19), fill=GREY)
        pen.text((tick, y + 21), f"{value:g}", INK, font(13), anchor="ma")
    said = "largest distance from the limit surface around each vertex of the cage"
    pen.text((width / 2, y + 39), said, GREY, font(13), anchor="ma")
    sheet.save(output, optimize=True)
    print(f"{output}: {output.stat().st_size >> 10} KiB")


if __name__ == "__main__":
    main()
