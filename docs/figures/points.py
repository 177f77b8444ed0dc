# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/points.md: instances whose size, direction and choice sources steer."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
from limit_surface.reading import attributes
from PIL import Image

from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, font, row_of_panels, save
from figures.steering import PIXELS, add_guides, paint_group, sheet

COMMON = {
    "distribution": "BLUE_NOISE", "amount": "COUNT", "count": 420, "seed": 1, "follow": "NONE",
}  # fmt: skip
STONE, LEAF = (0.28, 0.30, 0.34), (0.16, 0.34, 0.07)
COLOURS = {"Cone": (0.13, 0.30, 0.08), "Cube": (0.45, 0.22, 0.08), "Sphere": (0.55, 0.45, 0.10)}


@dataclass(frozen=True)
class Panel:
    title: str
    note: str
    properties: dict[str, object]
    things: Callable[[], None]
    prepare: Callable[[bpy.types.Object], None] = field(default=lambda _ob: None)


def stone() -> None:
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.035)
    _finish("Stone", STONE, (1.2, 0.8, 0.6))


def leaf() -> None:
    """A thin leaf along X, from the point on."""
    mesh = bpy.data.meshes.new("Leaf")
    x = np.linspace(0, 0.09, 9)
    half = 0.35 * x * (1 - (x / 0.09) ** 2) ** 0.5
    points = np.concatenate([np.stack([x, side * half, 0.12 * x], axis=1) for side in (1, -1)])
    faces = [(i, i + 9, i + 10, i + 1) for i in range(8)]
    mesh.from_pydata(points.tolist(), [], faces)
    ob = bpy.data.objects.new("Leaf", mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    _finish("Leaf", LEAF)


def shapes() -> None:
    """A collection of three shapes."""
    collection = bpy.data.collections.new("Shapes")
    bpy.ops.mesh.primitive_cone_add(radius1=0.022, depth=0.08)
    bpy.context.active_object.data.transform(_raised(0.04))
    _finish("Cone", COLOURS["Cone"], into=collection)
    bpy.ops.mesh.primitive_cube_add(size=0.03)
    bpy.context.active_object.data.transform(_raised(0.015))
    _finish("Cube", COLOURS["Cube"], into=collection)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.018)
    bpy.context.active_object.data.transform(_raised(0.018))
    _finish("Sphere", COLOURS["Sphere"], into=collection)


def rings(ob: bpy.types.Object) -> None:
    """Numbers that grow from the middle outwards."""
    positions = attributes.read(ob.data, "position")
    far = np.hypot(positions[:, 0], positions[:, 1]) / 0.6
    attributes.write(ob.data, "Rings", "FLOAT", "POINT", far.clip(max=0.999))


PANELS = (
    Panel(
        "Scale from a vertex group",
        "range 0.25 to 1.2, and Random Rotation",
        {
            "instance": "Stone",
            "random_rotation": np.pi,
            "random_scale": 0.3,
            "scale_source": "VERTEX_GROUP",
            "scale_vertex_group": "Long",
            "scale_range": (0.25, 1.2),
        },
        stone,
        paint_group,
    ),
    Panel(
        "Rotation from curves",
        "X along the flow of the blue curves",
        {"instance": "Leaf", "flow_source": "CURVES", "flow_curves": "Guides"},
        leaf,
        add_guides,
    ),
    Panel(
        "Members of a collection",
        "by an attribute; cone, cube, sphere",
        {
            "instances": "COLLECTION",
            "collection": "Shapes",
            "index_source": "ATTRIBUTE",
            "index_attribute": "Rings",
            "random_scale": 0.4,
        },
        shapes,
        rings,
    ),
)


def make(folder: Path, samples: int = 32) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{i}.png" for i in range(len(PANELS))]
        for panel, part in zip(PANELS, parts, strict=True):
            _draw(panel, part, samples)
        row = row_of_panels([Image.open(part) for part in parts], [p.title for p in PANELS], 34)
        for middle, panel in zip(row.middle, PANELS, strict=True):
            row.pen.text((middle, row.bottom + 6), panel.note, GREY, font(14), anchor="ma")
        save(row.sheet, folder / "points.png")


def _draw(panel: Panel, path: Path, samples: int) -> None:
    scene.start()
    panel.things()
    ob = sheet()
    panel.prepare(ob)
    bpy.context.view_layer.objects.active = ob
    bpy.ops.object.limit_points_add(**COMMON | panel.properties)
    scene.render(path, View(20, 48), np.array([0, 0, 0.05]), 1.55, PIXELS, samples)


def _raised(height: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[2, 3] = height
    return matrix


def _finish(
    name: str,
    colour: tuple[float, ...],
    scale: tuple[float, ...] = (1, 1, 1),
    into: bpy.types.Collection | None = None,
) -> None:
    """Names and colours the active object, which is shown on the points alone."""
    ob = bpy.context.active_object
    ob.name = ob.data.name = name
    matrix = np.diag([*scale, 1.0])
    ob.data.transform(matrix)
    if name in ("Stone", "Sphere"):
        ob.data.shade_smooth()
    ob.data.materials.append(scene.material(name, colour, 0.25))
    ob.hide_render = True
    if into is not None:
        into.objects.link(ob)
