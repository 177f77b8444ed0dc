# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/distribution.md: the distributions, and densities from three sources."""

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.reading import attributes
from PIL import Image

from figures.meshes.grids import grid_faces
from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, font, row_of_panels, save

PIXELS = (400, 350)
SIDE = 8  # faces along each side of the sheet
CLAY, SEED = (0.55, 0.50, 0.44), (0.02, 0.05, 0.16)


@dataclass(frozen=True)
class Panel:
    title: str
    note: str
    properties: dict[str, object]
    prepare: Callable[[bpy.types.Object], None] = field(default=lambda _ob: None)


def paint_group(ob: bpy.types.Object) -> None:
    """The weights grow from left to right."""
    group = ob.vertex_groups.new(name="Scalp")
    for vertex in ob.data.vertices:
        group.add([vertex.index], float(np.clip(vertex.co.x + 0.5, 0, 1)) ** 2, "REPLACE")


def paint_image(ob: bpy.types.Object) -> None:
    """Rings on a dark ground, over the whole sheet."""
    size = 256
    y, x = (np.mgrid[:size, :size] + 0.5) / size - 0.5
    values = 0.02 + 0.98 * (0.5 + 0.5 * np.cos(36 * np.hypot(x, y))) ** 3
    pixels = np.repeat(values[:, :, None], 4, axis=2).astype(np.float32)
    bpy.data.images.new("Rings", size, size, float_buffer=True).pixels.foreach_set(pixels.ravel())
    uv = attributes.read(ob.data, "position")[attributes.read(ob.data, ids.CORNER_VERTEX), :2] + 0.5
    ob.data.uv_layers.new(name="UVMap").data.foreach_set("uv", uv.ravel())


def paint_slots(ob: bpy.types.Object) -> None:
    """Gives a second material to a chequered pattern of faces."""
    ob.data.materials.append(surface_material("Other", (0.30, 0.36, 0.42)))
    row, column = np.divmod(np.arange(SIDE * SIDE), SIDE)
    chosen = ((row // 2 + column // 2) % 2).astype(np.int32)
    ob.data.polygons.foreach_set("material_index", chosen)


DISTRIBUTIONS = (
    Panel("Jittered", "6 x 6 on each face", {"per_side": 6}),
    Panel("Uniform", "2304 by area", {"distribution": "UNIFORM", "count": 36 * SIDE**2}),
    Panel(
        "Blue noise",
        "2304 by area, evenly apart",
        {"distribution": "BLUE_NOISE", "count": 36 * SIDE**2},
    ),
)
DENSITIES = (
    Panel(
        "Vertex group",
        "weights 0 on the left to 1 on the right",
        {
            "distribution": "BLUE_NOISE",
            "count": 1500,
            "density_source": "VERTEX_GROUP",
            "vertex_group": "Scalp",
        },
        paint_group,
    ),
    Panel(
        "Image",
        "rings, placed by the UV map",
        {
            "distribution": "BLUE_NOISE",
            "count": 3000,
            "density_source": "IMAGE",
            "image": "Rings",
        },
        paint_image,
    ),
    Panel(
        "Material slot",
        "blue noise on the faces of slot 1",
        {"distribution": "BLUE_NOISE", "distance": 0.02, "material_slots": {"1"}},
        paint_slots,
    ),
)


def make_distributions(folder: Path, samples: int = 32) -> None:
    make(DISTRIBUTIONS, folder / "distribution.png", samples)


def make_densities(folder: Path, samples: int = 32) -> None:
    make(DENSITIES, folder / "density.png", samples)


def make(panels: Sequence[Panel], output: Path, samples: int) -> None:
    scene.start()
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{i}.png" for i in range(len(panels))]
        for panel, part in zip(panels, parts, strict=True):
            draw(panel, part, samples)
        save(composed(parts, panels), output)


def draw(panel: Panel, path: Path, samples: int) -> None:
    ob = sheet()
    panel.prepare(ob)
    bpy.ops.object.limit_points_add(seed=1, instance=seed().name, **panel.properties)
    scene.render(path, View(0, 55), np.array([0, -0.01, 0.03]), 1.12, PIXELS, samples)
    for made in list(bpy.data.objects):
        bpy.data.objects.remove(made)


def sheet() -> bpy.types.Object:
    """An open, bent sheet whose faces are narrower to the left and to the front."""
    at = np.linspace(0, 1, SIDE + 1) ** 1.6 - 0.5
    y, x = (grid.ravel() for grid in np.meshgrid(at, at, indexing="ij"))
    height = 0.10 * np.sin(5 * x + 1) * np.cos(4 * y)
    faces = grid_faces(SIDE, SIDE)
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(np.stack([x, y, height], axis=1).tolist(), [], faces.tolist())
    mesh.materials.append(surface_material("Clay", CLAY))
    mesh.shade_smooth()
    ob = bpy.data.objects.new("Sheet", mesh)
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.render_levels, subsurf.boundary_smooth = 5, "PRESERVE_CORNERS"
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    return ob


def seed() -> bpy.types.Object:
    """The small ball that stands on each point."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=8, radius=0.0042)
    ball = bpy.context.active_object
    ball.location = (0, 0, -50)  # itself out of sight
    ball.data.materials.append(surface_material("Seed", SEED))
    bpy.context.view_layer.objects.active = bpy.data.objects["Sheet"]
    return ball


def surface_material(name: str, colour: Sequence[float]) -> bpy.types.Material:
    return scene.material(name, colour, glow=0.3, roughness=0.6, specular=0.2)


def composed(parts: Sequence[Path], panels: Sequence[Panel]) -> Image.Image:
    """The panels side by side, titles above and notes below."""
    row = row_of_panels([Image.open(part) for part in parts], [panel.title for panel in panels], 34)
    for middle, panel in zip(row.middle, panels, strict=True):
        row.pen.text((middle, row.bottom + 6), panel.note, GREY, font(14), anchor="ma")
    return row.sheet
