# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/curvature.md: the curvature of an open mesh with a pole, as
object.limit_curvature stores it: as colours and as strokes along the principal directions."""

import tempfile
from pathlib import Path

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.curvature import colours
from limit_surface.reading import attributes
from PIL import Image, ImageDraw

from figures.meshes.grids import fan
from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, INK, colour_bar, font, on_screen, row_of_panels, save

SECTORS, SIDE = 7, 3  # around the pole; quads along the side of each
HOLE = 13  # the face that is missing
LEVELS = 4
SPACING = 0.115  # of the strokes
STROKE, RADIUS, MARK = 0.075, 0.005, 0.013
LIFT = 0.004  # distance of the strokes from the surface
PIXELS, WIDTH = (560, 430), 2.8
VIEW, TARGET = View(18, 42), np.array([-0.01, 0.0, 0.02])
PANELS = (("MEAN", "Mean curvature", 2.5), ("GAUSSIAN", "Gaussian curvature", 5.0))
DARK, PALE = (0.01, 0.01, 0.015), (0.9, 0.75, 0.1)


def make(folder: Path, samples: int = 32) -> None:
    scene.start()
    cage = sheet()
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{quantity}.png" for quantity, _, _ in PANELS]
        for part, (quantity, _, full) in zip(parts, PANELS, strict=True):
            draw(cage, quantity, full)
            scene.render(part, VIEW, TARGET, WIDTH, PIXELS, samples)
            scene.clear()
        save(composed(parts), folder / "curvature.png")


def sheet() -> bpy.types.Object:
    """A bent sheet of sectors of quads around a pole, with a hole. It is not rendered itself."""
    made = fan(SECTORS, SIDE)
    faces = np.delete(made.faces, HOLE, axis=0)
    angle = 2 * np.pi * (made.sector + made.j / np.maximum(made.i + made.j, 1)) / SECTORS
    radius = 1.3 / SIDE * np.maximum(made.i, made.j)
    flat = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    height = 0.15 * radius**2 * np.cos(3 * angle) + 0.7 * np.exp(-3.5 * radius**2)
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(np.column_stack([flat, height]).tolist(), [], faces.tolist())
    ob = bpy.data.objects.new("Sheet", mesh)
    bpy.context.collection.objects.link(ob)
    ob.hide_render = True
    return ob


def draw(cage: bpy.types.Object, quantity: str, full: float) -> None:
    """Shows only what the operator has stored."""
    run(cage, on="TESSELLATION", levels=LEVELS, color=quantity, full_color=full)
    made = bpy.context.active_object
    color = attributes.read(made.data, ids.CURVATURE_COLOR)[:, :3]
    position = attributes.read(made.data, ids.POSITION)
    quads = attributes.read(made.data, ids.CORNER_VERTEX).reshape(-1, 4)
    irregular = position[attributes.read(made.data, ids.CURVATURE_IRREGULAR)]
    bpy.data.batch_remove([made, made.data])
    scene.add_surface(quads, position, color)
    toward = scene.axes(VIEW)[:, 2]
    scene.add_lines("Marks", [squares(irregular + 2 * MARK * toward)], MARK, DARK)

    if quantity == "MEAN":
        add_strokes(cage, toward)


def add_strokes(cage: bpy.types.Object, toward: np.ndarray) -> None:
    select(cage)
    bpy.ops.object.limit_points_add(distribution="BLUE_NOISE", distance=SPACING, seed=1)
    points = bpy.context.active_object
    run(points, on="ROOTS")
    root = attributes.read(points.data, ids.POSITION) + LIFT * toward
    for name, attribute, ink in (
        ("K1", ids.CURVATURE_DIRECTION1, DARK),
        ("K2", ids.CURVATURE_DIRECTION2, PALE),
    ):
        half = STROKE / 2 * attributes.read(points.data, attribute)
        scene.add_lines(name, [np.stack([root - half, root + half], axis=1)], RADIUS, ink)
    bpy.data.batch_remove([points, points.data])


def run(ob: bpy.types.Object, **properties: object) -> None:
    select(ob)
    bpy.ops.object.limit_curvature(**properties)


def select(ob: bpy.types.Object) -> None:
    for other in bpy.context.selected_objects:
        other.select_set(False)
    ob.select_set(True)
    bpy.context.view_layer.objects.active = ob


def squares(place: np.ndarray) -> np.ndarray:
    """Lines that are as long as wide, at right angles to the line of sight."""
    aside = MARK * scene.axes(VIEW)[:, 0]
    return np.stack([place - aside, place + aside], axis=1)


def composed(parts: list[Path]) -> Image.Image:
    """The panels side by side, each with its scale below."""
    row = row_of_panels([Image.open(part) for part in parts], [title for _, title, _ in PANELS], 92)
    for middle, (_, _, full) in zip(row.middle, PANELS, strict=True):
        draw_scale(row.sheet, row.pen, int(middle), row.bottom + 8, full)
    said = (
        "strokes: principal directions, dark of k1, the larger one, yellow of k2; "
        "squares: irregular vertices, averaged"
    )
    row.pen.text((row.sheet.width / 2, row.sheet.height - 26), said, GREY, font(13), anchor="ma")
    return row.sheet


def draw_scale(
    picture: Image.Image, pen: ImageDraw.ImageDraw, middle: int, y: int, full: float
) -> None:
    bar = on_screen(colours.of_values(np.linspace(-full, full, 301), full)[:, :3])
    x = middle - len(bar) // 2
    picture.paste(colour_bar(bar), (x, y))
    for part in (-1, -0.5, 0, 0.5, 1):
        tick = middle + part * (len(bar) // 2)
        pen.line((tick, y + 14, tick, y + 19), fill=GREY)
        pen.text((tick, y + 21), f"{part * full:g}", INK, font(13), anchor="ma")
