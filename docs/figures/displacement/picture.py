# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/displacement.md: a head, the map that object.limit_bake_displacement makes of
a sculpt of it, the head rendered with that map, and the sculpt itself."""

import tempfile
from pathlib import Path

import bpy
import numpy as np
from limit_surface.images import image_pixels
from PIL import Image

from figures.displacement import head as heads
from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, font, row_of_panels, save

SIZE = 1024  # texels along a side of the map
RENDERED = {"Head": 4, "Sculpt": 1}  # levels
PIXELS, WIDTH = (330, 330), 2.75
VIEW, TARGET = View(24, 10), np.array([0.1, 0.0, 0.02])
TITLES = ("Mesh", "Displacement map", "Mesh and map, rendered", "Sculpted mesh")
FULL = 0.11  # a component of this length is shown as bright, or as dark, as possible
CLAY = (0.55, 0.42, 0.33)


def make(folder: Path, samples: int = 32) -> None:
    scene.start()
    head = heads.add_base()
    sculpt = heads.add_sculpt(head)
    for ob in (head, sculpt):
        ob.modifiers[0].render_levels = RENDERED[ob.name]
        # Each has its own, because the operator adds the displacement to that of the head.
        ob.data.materials.append(scene.material(f"{ob.name} clay", CLAY, glow=0.06, specular=0))
        ob.data.shade_smooth()
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{i}.png" for i in range(3)]
        render(head, parts[0], samples)
        bpy.ops.object.limit_bake_displacement(
            target=sculpt.name, width=SIZE, height=SIZE, margin=4, create_material=True
        )
        render(head, parts[1], samples)
        render(sculpt, parts[2], samples)
        shown = [Image.open(part) for part in parts]
        shown.insert(1, drawn(image_pixels.read(bpy.data.images["Head Displacement"])))
        save(composed(shown), folder / "displacement.png")


def render(ob: bpy.types.Object, path: Path, samples: int) -> None:
    for other in bpy.context.scene.objects:
        other.hide_render = other.type == "MESH" and other != ob
    scene.render(path, VIEW, TARGET, WIDTH, PIXELS, samples)


def drawn(pixels: np.ndarray) -> Image.Image:
    """The numbers as colours: 0 is grey, and texels without a place are white."""
    shown = np.clip(0.5 + 0.5 * pixels[::-1, :, :3] / FULL, 0, 1)
    shown[(pixels[::-1, :, :3] == 0).all(axis=2)] = 1
    made = Image.fromarray(np.uint8(np.rint(255 * shown)))
    return made.resize(PIXELS, Image.Resampling.BOX)


def composed(shown: list[Image.Image]) -> Image.Image:
    row = row_of_panels(shown, TITLES, 34, gap=12, top=38)
    said = (
        f"{SIZE} x {SIZE} texels; red, green, blue along tangent, normal, bitangent, "
        "grey where nothing moves"
    )
    row.pen.text((row.sheet.width / 2, row.bottom + 10), said, GREY, font(14), anchor="ma")
    return row.sheet
