# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of hair and points along borders: lashes, rows, and a crease."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.reading import attributes
from PIL import Image

from figures.distribution import CLAY, seed, surface_material
from figures.meshes.grids import grid_faces
from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, font, row_of_panels, save

PIXELS = (380, 360)
SIDE = 10
HAIR = (0.05, 0.03, 0.02)


@dataclass(frozen=True)
class Panel:
    title: str
    note: str
    make: Callable[[bpy.types.Object], None]


def lashes(ob: bpy.types.Object) -> None:
    chosen = _edges_around_hole(ob)
    ob.data.edges.foreach_set("select", chosen)
    bpy.ops.object.limit_hair_add(
        distribution="BORDER",
        border="SELECTED",
        count=150,
        border_jitter=0.5,
        direction="OUTWARDS",
        lift=0.9,
        length=0.13,
        random=0.12,
        radius=0.0022,
    )
    bpy.context.active_object.data.materials.append(surface_material("Hair", HAIR))


def rows(_ob: bpy.types.Object) -> None:
    bpy.ops.object.limit_points_add(
        distribution="BORDER", distance=0.03, rows=5, row_distance=0.04, instance=seed().name
    )


def crease(ob: bpy.types.Object) -> None:
    middle = np.abs(_edge_middles(ob)[:, 1] + 0.3) < 1e-4
    values = (middle & (np.ptp(_edge_ends(ob)[:, :, 1], axis=1) < 1e-4)).astype(np.float32)
    attributes.write(ob.data, ids.EDGE_CREASE, "FLOAT", "EDGE", values)
    bpy.ops.object.limit_hair_add(
        distribution="BORDER",
        border="CREASES",
        count=120,
        flow=0.9,
        length=0.1,
        random=0.1,
        radius=0.0022,
    )
    bpy.context.active_object.data.materials.append(surface_material("Hair", HAIR))


PANELS = (
    Panel("Lashes", "selected edges; outwards, lifted", lashes),
    Panel("Rows", "5 rows along the boundaries; they end where they meet", rows),
    Panel("A crease", "along the normal, flow 50 degrees", crease),
)


def make(folder: Path, samples: int = 32) -> None:
    scene.start()
    with tempfile.TemporaryDirectory() as temporary:
        parts = []
        for i, panel in enumerate(PANELS):
            ob = _sheet()
            panel.make(ob)
            parts.append(Path(temporary) / f"{i}.png")
            target = np.array([0, 0, 0.04])
            scene.render(parts[-1], View(15, 42), target, 1.25, PIXELS, samples)
            for made in list(bpy.data.objects):
                bpy.data.objects.remove(made)
        row = row_of_panels(
            [Image.open(part) for part in parts], [panel.title for panel in PANELS], 34
        )
        for middle, panel in zip(row.middle, PANELS, strict=True):
            row.pen.text((middle, row.bottom + 6), panel.note, GREY, font(14), anchor="ma")
        save(row.sheet, folder / "border.png")


def _sheet() -> bpy.types.Object:
    """An open, bent sheet with a hole."""
    at = np.linspace(-0.5, 0.5, SIDE + 1)
    y, x = (grid.ravel() for grid in np.meshgrid(at, at, indexing="ij"))
    height = 0.25 - 0.7 * (x**2 + 0.5 * y**2)
    row, column = np.divmod(np.arange(SIDE * SIDE), SIDE)
    hole = (np.abs(row - 5.5) < 1) & (np.abs(column - 4.5) < 2)
    faces = grid_faces(SIDE, SIDE)[~hole]
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(np.stack([x, y, height], axis=1).tolist(), [], faces.tolist())
    mesh.materials.append(surface_material("Clay", CLAY))
    mesh.shade_smooth()
    ob = bpy.data.objects.new("Sheet", mesh)
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.levels, subsurf.render_levels = 1, 5
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    return ob


def _edge_ends(ob: bpy.types.Object) -> np.ndarray:
    """Returns the positions (edges, 2, 3) of the edges' vertices."""
    return attributes.read(ob.data, "position")[attributes.read(ob.data, ids.EDGE_VERTICES)]


def _edge_middles(ob: bpy.types.Object) -> np.ndarray:
    return _edge_ends(ob).mean(axis=1)


def _edges_around_hole(ob: bpy.types.Object) -> np.ndarray:
    uses = np.bincount(attributes.read(ob.data, ids.CORNER_EDGE), minlength=len(ob.data.edges))
    return (uses == 1) & (np.abs(_edge_middles(ob)[:, :2]).max(axis=1) < 0.4)
