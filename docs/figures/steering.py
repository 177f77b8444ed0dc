# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/distribution.md about strands that are steered, and of docs/blender.md about
Blender's own hair nodes on them.
"""

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

PIXELS = (400, 330)
SIDE = 6  # faces along each side of the sheet
SKIN, HAIR, LINE = (0.60, 0.42, 0.33), (0.12, 0.055, 0.02), (0.05, 0.35, 0.75)
ASSETS = "procedural_hair_node_assets.blend"
COMMON = {"per_side": 14, "length": 0.16, "radius": 0.0012, "seed": 2, "follow": "NONE"}


@dataclass(frozen=True)
class Panel:
    title: str
    note: str
    properties: dict[str, object]
    prepare: Callable[[bpy.types.Object], None] = field(default=lambda _ob: None)
    nodes: tuple[tuple[str, dict[str, float]], ...] = ()  # Blender's groups, with their inputs


def paint_group(ob: bpy.types.Object) -> None:
    """The weights are 1 in the middle, and 0 at the border."""
    group = ob.vertex_groups.new(name="Long")
    for vertex in ob.data.vertices:
        far = float(np.hypot(vertex.co.x, vertex.co.y)) / 0.6
        group.add([vertex.index], max(1 - far, 0), "REPLACE")


def paint_flow_map(ob: bpy.types.Object) -> None:
    """Waves: red is to the right, green to the back."""
    size = 128
    y, x = (np.mgrid[:size, :size] + 0.5) / size
    turn = np.pi / 2 + 1.2 * np.sin(2 * np.pi * (x + 0.3 * y))
    pixels = np.ones((size, size, 4), np.float32)
    pixels[:, :, :2] = 0.5 + 0.5 * np.stack([np.cos(turn), np.sin(turn)], axis=2)
    image = bpy.data.images.new("Comb", size, size, float_buffer=True, is_data=True)
    image.pixels.foreach_set(pixels.ravel())
    uv = attributes.read(ob.data, "position")[attributes.read(ob.data, ids.CORNER_VERTEX), :2] + 0.5
    ob.data.uv_layers.new(name="UVMap").data.foreach_set("uv", uv.ravel())


def add_guides(_ob: bpy.types.Object) -> None:
    """A circle to the left, and a line on the right."""
    data = bpy.data.curves.new("Guides", "CURVE")
    data.dimensions, data.bevel_depth = "3D", 0.004
    turn = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    circle = np.stack([0.16 * np.cos(turn) - 0.2, 0.16 * np.sin(turn)], axis=1)
    line = np.stack([0.36 + 0.04 * np.sin(np.linspace(0, 6, 24)), np.linspace(-0.45, 0.45, 24)],
                    axis=1)  # fmt: skip
    for points, is_cyclic in ((circle, True), (line, False)):
        spline = data.splines.new("POLY")
        spline.points.add(len(points) - 1)
        spline.use_cyclic_u = is_cyclic
        for point, (x, y) in zip(spline.points, points, strict=True):
            point.co = (x, y, height(x, y) + 0.05, 1)
    data.materials.append(scene.material("Line", LINE, 0.6, 0.6, 0.1))
    bpy.context.collection.objects.link(bpy.data.objects.new("Guides", data))


STEERED = (
    Panel(
        "Length from a vertex group",
        "range 0.15 to 1",
        {
            "length_source": "VERTEX_GROUP",
            "length_vertex_group": "Long",
            "length_range": (0.15, 1.0),
            "random": 0.15,
        },
        paint_group,
    ),
    Panel(
        "Flow from an image",
        "red is along U, green along V",
        {"flow_source": "IMAGE", "flow_image": "Comb", "flow_angle": 1.25},
        paint_flow_map,
    ),
    Panel(
        "Flow from curves",
        "the blue curves, over the whole surface",
        {"flow_source": "CURVES", "flow_curves": "Guides", "flow_angle": 1.25},
        add_guides,
    ),
)
_COMBED = {"flow_source": "CURVES", "flow_curves": "Guides", "flow_angle": 0.7, "points": 12}
_CLUMP = ("Clump Hair Curves", {"Guide Distance": 0.05, "Shape": 0.3})
_NOISE = ("Hair Curves Noise", {"Distance": 0.01, "Scale": 6.0, "Scale along Curve": 2.0})
WITH_NODES = (
    Panel("As it is made", "combed along curves", _COMBED, add_guides),
    Panel("Clump Hair Curves", "Guide Distance 0.05", _COMBED, add_guides, (_CLUMP,)),
    Panel("Clump, then Hair Curves Noise", "Distance 0.01", _COMBED, add_guides, (_CLUMP, _NOISE)),
)


def make_steering(folder: Path, samples: int = 32) -> None:
    make(STEERED, folder / "steering.png", samples)


def make_hair_nodes(folder: Path, samples: int = 32) -> None:
    make(WITH_NODES, folder / "hair_nodes.png", samples)


def make(panels: Sequence[Panel], output: Path, samples: int) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{i}.png" for i in range(len(panels))]
        for panel, part in zip(panels, parts, strict=True):
            draw(panel, part, samples)
        row = row_of_panels([Image.open(part) for part in parts], [p.title for p in panels], 34)
        for middle, panel in zip(row.middle, panels, strict=True):
            row.pen.text((middle, row.bottom + 6), panel.note, GREY, font(14), anchor="ma")
        save(row.sheet, output)


def draw(panel: Panel, path: Path, samples: int) -> None:
    scene.start()
    ob = sheet()
    panel.prepare(ob)
    bpy.context.view_layer.objects.active = ob
    bpy.ops.object.limit_hair_add(**COMMON | panel.properties)
    hair = bpy.context.active_object
    hair.data.materials.append(scene.material("Hair", HAIR, 0.25, 0.45, 0.4))
    for name, inputs in panel.nodes:
        add_nodes(hair, name, inputs)
    scene.render(path, View(20, 48), np.array([0, 0, 0.05]), 1.55, PIXELS, samples)


def add_nodes(hair: bpy.types.Object, name: str, inputs: dict[str, float]) -> None:
    """Adds one of the groups that come with Blender, as the menu Add Modifier > Hair does."""
    path = next((Path(bpy.utils.resource_path("LOCAL")) / "datafiles/assets").rglob(ASSETS))
    with bpy.data.libraries.load(str(path), assets_only=True) as (_there, here):
        here.node_groups = [name]
    modifier = hair.modifiers.new(name, "NODES")
    modifier.node_group = here.node_groups[0]
    for socket, value in inputs.items():
        modifier[modifier.node_group.interface.items_tree[socket].identifier] = value


def height(x: np.ndarray | float, y: np.ndarray | float) -> np.ndarray | float:
    return 0.12 * np.cos(2.2 * x) * np.cos(2.2 * y)


def sheet() -> bpy.types.Object:
    """An open, bent sheet."""
    at = np.linspace(-0.5, 0.5, SIDE + 1)
    y, x = (grid.ravel() for grid in np.meshgrid(at, at, indexing="ij"))
    mesh = bpy.data.meshes.new("Sheet")
    positions = np.stack([x, y, height(x, y)], axis=1)
    mesh.from_pydata(positions.tolist(), [], grid_faces(SIDE, SIDE).tolist())
    mesh.materials.append(scene.material("Skin", SKIN, 0.25, 0.6, 0.2))
    mesh.shade_smooth()
    ob = bpy.data.objects.new("Sheet", mesh)
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.render_levels, subsurf.quality = 4, 10
    bpy.context.collection.objects.link(ob)
    return ob
