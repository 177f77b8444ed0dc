# SPDX-License-Identifier: Apache-2.0
"""The icon and the wide picture of the page on extensions.blender.org: the paper's figure 1 in the
sizes that are asked for there.
"""

from pathlib import Path

import bpy
from mathutils import Vector

from figures import figure1
from figures.meshes import obj
from figures.rendering.quiet import quiet

HAIRS, RADIUS = 70, 0.0017  # strands along each side of a face
ICON_HAIRS, ICON_RADIUS = 24, 0.007  # fewer and thicker ones, for a few pixels
ICON_WIDTH, CROSS_WIDTH = 256, 3.3


def make_icon(folder: Path, samples: int = 64) -> None:
    start()
    add_hair(ICON_HAIRS, ICON_RADIUS, Vector((0, 0, 0)))
    figure1.set_up_picture(ICON_WIDTH, samples)
    scene = bpy.context.scene
    scene.camera.data.ortho_scale = CROSS_WIDTH
    scene.render.film_transparent = True
    scene.render.image_settings.color_mode = "RGBA"
    render(folder / "icon.png", ICON_WIDTH, ICON_WIDTH)


def make_featured(folder: Path, samples: int = 32) -> None:
    start()
    left, right = (Vector((sign * figure1.SPACING / 2, 0, 0)) for sign in (-1, 1))
    figure1.add_cage_and_surface(*obj.read(obj.CROSS), left)
    add_hair(HAIRS, RADIUS, right)
    figure1.set_up_picture(1920, samples)
    bpy.context.scene.camera.data.ortho_scale = 2 * figure1.SPACING
    render(folder / "featured.png", 1920, 1080)


def start() -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    figure1.material("Surface", figure1.SURFACE_BLUE, roughness=0.45)


def add_hair(per_side: int, radius: float, at: Vector) -> None:
    figure1.add_hairy_surface(*obj.read(obj.CROSS), per_side, radius, at)


def render(path: Path, width: int, height: int) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    settings = bpy.context.scene.render
    settings.resolution_x, settings.resolution_y = width, height
    settings.filepath = str(path)
    with quiet():
        bpy.ops.render.render(write_still=True)
