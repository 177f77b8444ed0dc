# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/limit_mesh.md: meshes that object.limit_mesh makes. Above, with as many
polygons everywhere and with as many as flatness asks for; below, few polygons with Blender's
normals and with exact ones."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
from limit_surface import ids, native
from limit_surface.reading import attributes
from limit_surface.reading import cage as cages
from PIL import Image, ImageDraw

from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import GREY, INK, font, save

TOLERANCE = 0.005
GAP, TITLE, NOTE = 14, 34, 26
WIRE, DARK = 0.0024, (0.02, 0.02, 0.03)
CLAY = (0.62, 0.56, 0.42)
STRIPES = 12.0  # half waves of the pattern from the middle of a ball to its rim
SIDES = 6  # of the vase
PROFILE = ((0.55, 0.0), (1.1, 0.5), (1.15, 1.2), (0.5, 1.45), (0.75, 2.0))  # radii and heights
SHOULDER = 2  # the ring of these that is creased


@dataclass(frozen=True)
class Panel:
    title: str
    add: Callable[[], bpy.types.Object]
    properties: dict[str, object]
    view: View
    middle: tuple[float, float, float]
    width: float
    pixels: tuple[int, int]
    striped: bool = False
    found: list[str] = field(default_factory=list)  # the note below


def monkey() -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    return bpy.context.active_object


def vase() -> bpy.types.Object:
    """A vase that is open at the top and has a crease around its shoulder."""
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    rings = [radius * circle + [0, 0, height] for radius, height in PROFILE]
    here = np.arange(SIDES)
    after = (here + 1) % SIDES
    walls = [
        np.stack([here, after, after + SIDES, here + SIDES], axis=1) + SIDES * ring
        for ring in range(len(PROFILE) - 1)
    ]
    mesh = bpy.data.meshes.new("Vase")
    faces = [here[::-1].tolist(), *np.concatenate(walls).tolist()]
    mesh.from_pydata(np.concatenate(rings).tolist(), [], faces)
    mesh.shade_smooth()
    ring = attributes.read(mesh, ids.EDGE_VERTICES) // SIDES
    attributes.write(mesh, ids.EDGE_CREASE, "FLOAT", "EDGE", (ring == SHOULDER).all(axis=1))
    ob = bpy.data.objects.new("Vase", mesh)
    bpy.context.collection.objects.link(ob)
    return ob


FRONT = {"view": View(25, 12), "middle": (0.12, 0, 0.01), "width": 2.78, "pixels": (600, 460)}
ABOVE = {"view": View(20, 24), "middle": (0, 0, 1.09), "width": 2.55, "pixels": (395, 370)}
ROWS = (
    (
        Panel("Levels: uniform", monkey, {"levels": 2}, **FRONT),
        Panel("Levels: flatness", monkey,
              {"level_source": "FLATNESS", "tolerance": TOLERANCE}, **FRONT),
    ),
    (
        Panel("Blender's own normals", vase, {"levels": 2, "exact_normals": False},
              striped=True, **ABOVE),
        Panel("Exact normals", vase, {"levels": 2}, striped=True, **ABOVE),
        Panel("The surface", vase, {"levels": 5}, striped=True, **ABOVE),
    ),
)  # fmt: skip


def make(folder: Path, samples: int = 32) -> None:
    scene.start()
    with tempfile.TemporaryDirectory() as temporary:
        rows = [
            [
                (panel, draw(panel, Path(temporary) / f"{i}{k}.png", samples))
                for k, panel in enumerate(row)
            ]
            for i, row in enumerate(ROWS)
        ]
        save(composed(rows), folder / "limit_mesh.png")


def draw(panel: Panel, path: Path, samples: int) -> Path:
    cage = panel.add()
    cage.modifiers.new("Subdivision", "SUBSURF")
    bpy.context.view_layer.objects.active = cage
    bpy.ops.object.limit_mesh(hide_original=True, **panel.properties)
    made = bpy.context.active_object
    panel.found[:] = said(cage, made, panel)
    made.data.materials.clear()
    made.data.materials.append(stripes() if panel.striped else clay())
    if not panel.striped:
        add_wires(made.data, scene.axes(panel.view)[:, 2])
    scene.render(path, panel.view, np.array(panel.middle), panel.width, panel.pixels, samples)
    bpy.data.batch_remove([ob for ob in bpy.context.scene.objects if ob.type != "CAMERA"])
    return path


def said(cage: bpy.types.Object, made: bpy.types.Object, panel: Panel) -> list[str]:
    count = f"{len(made.data.polygons):,} polygons"
    if panel.striped:
        return [count]
    surface = native.limitsurf.LimitSurface(
        cages.read(cage, bpy.context.evaluated_depsgraph_get()).mesh
    )
    centres = np.array([polygon.center for polygon in made.data.polygons])
    return [f"{count}, their centres at most {surface.closest(centres).distance.max():.4f} off"]


def add_wires(mesh: bpy.types.Mesh, toward: np.ndarray) -> None:
    position = attributes.read(mesh, ids.POSITION)
    lines = position[attributes.read(mesh, ids.EDGE_VERTICES)] + WIRE / 2 * toward
    scene.add_lines("Wires", [lines], WIRE, DARK)


def clay() -> bpy.types.Material:
    return scene.material("Clay", CLAY, glow=scene.GLOW, roughness=0.6, specular=0.2)


def stripes() -> bpy.types.Material:
    """Light and dark stripes by the angle between the shading normal and the line of sight."""
    made = bpy.data.materials.new("Stripes")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    across = nodes.new("ShaderNodeVectorTransform")
    across.vector_type, across.convert_from, across.convert_to = "NORMAL", "WORLD", "CAMERA"
    links.new(nodes.new("ShaderNodeNewGeometry").outputs["Normal"], across.inputs[0])
    parts = nodes.new("ShaderNodeSeparateXYZ")
    links.new(across.outputs[0], parts.inputs[0])
    wave = math(nodes, links, "MULTIPLY", parts.outputs["Y"], STRIPES * np.pi / 2)
    wave = math(nodes, links, "SINE", wave)
    wave = math(nodes, links, "MULTIPLY_ADD", wave, 4.0, 0.5)
    colour = nodes.new("ShaderNodeMix")
    colour.data_type, colour.clamp_factor = "RGBA", True
    links.new(wave, colour.inputs[0])
    colour.inputs[6].default_value = (0.03, 0.05, 0.11, 1)
    colour.inputs[7].default_value = (0.75, 0.72, 0.62, 1)
    light, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    links.new(colour.outputs[2], light.inputs["Color"])
    links.new(light.outputs[0], output.inputs["Surface"])
    return made


def math(
    nodes: bpy.types.Nodes,
    links: bpy.types.NodeLinks,
    operation: str,
    first: bpy.types.NodeSocket,
    *numbers: float,
) -> bpy.types.NodeSocket:
    node = nodes.new("ShaderNodeMath")
    node.operation = operation
    links.new(first, node.inputs[0])
    for socket, number in zip(node.inputs[1:], numbers, strict=False):
        socket.default_value = number
    return node.outputs[0]


def composed(rows: list[list[tuple[Panel, Path]]]) -> Image.Image:
    widths = [sum(panel.pixels[0] + GAP for panel, _ in row) + GAP for row in rows]
    heights = [TITLE + row[0][0].pixels[1] + NOTE for row in rows]
    sheet = Image.new("RGB", (max(widths), sum(heights) + GAP), "white")
    pen, top = ImageDraw.Draw(sheet), 0
    for row, width, height in zip(rows, widths, heights, strict=True):
        left = GAP + (sheet.width - width) // 2
        for panel, path in row:
            picture, middle = Image.open(path), left + panel.pixels[0] / 2
            sheet.paste(picture, (left, top + TITLE), picture)
            pen.text((middle, top + 9), panel.title, INK, font(17), anchor="ma")
            below = top + TITLE + panel.pixels[1]
            pen.text((middle, below + 4), panel.found[0], GREY, font(13), anchor="ma")
            left += panel.pixels[0] + GAP
        top += height
    return sheet.quantize(255, dither=Image.Dither.NONE)
