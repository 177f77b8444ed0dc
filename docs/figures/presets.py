# SPDX-License-Identifier: Apache-2.0
"""The picture of the shipped presets: what each of them makes, as docs/blender.md shows it."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy
import limit_surface
import numpy as np
from PIL import Image, ImageDraw

from figures.meshes.grids import grid_faces
from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import INK, font, save

PIXELS = (400, 340)
GAP, TITLE, COLUMNS = 10, 30, 3
SKIN, LAWN, HIDE = (0.60, 0.42, 0.33), (0.16, 0.11, 0.06), (0.10, 0.13, 0.10)
FUR, HAIR, GREEN, DARK = (0.13, 0.06, 0.02), (0.10, 0.05, 0.02), (0.10, 0.28, 0.03), (0.02,) * 3
SCALY = (0.20, 0.33, 0.22)
HEAD = (View(25, 12), np.array([0, -0.1, 0.0]), 3.6)
FOLDER = Path(limit_surface.__file__).parent / "presets/operator"


def head() -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    return bpy.context.active_object


def lawn() -> bpy.types.Object:
    """A gentle hill."""
    y, x = np.mgrid[:9, :9].reshape(2, -1) / 4 - 1.0
    return add("Lawn", np.stack([x, y, 0.3 * np.cos(1.4 * x) * np.cos(1.4 * y)], axis=1), 8)


def lid() -> bpy.types.Object:
    """A bent band, open on all sides, of which one edge loop is selected."""
    along, across = np.mgrid[:9, :4].reshape(2, -1)
    turn = (along / 8 - 0.5) * 2.2
    high = 0.16 * across
    x, y = np.sin(turn), -np.cos(turn)
    z = 0.45 * np.cos(1.1 * turn) + high - 0.2
    positions = np.stack([x * (1 - 0.1 * across), y * (1 - 0.08 * across), z], axis=1)
    ob = add("Lid", positions, 3, 8)
    chosen = [all(i % 4 == 0 for i in edge.vertices) for edge in ob.data.edges]
    ob.data.edges.foreach_set("select", chosen)
    return ob


@dataclass(frozen=True)
class Panel:
    title: str
    operator: str
    surface: Callable[[], bpy.types.Object]
    colours: tuple[tuple[float, ...], tuple[float, ...]]  # of the surface, and of what stands on it
    view: tuple[View, np.ndarray, float]
    properties: tuple[tuple[str, object], ...] = ()

    @property
    def path(self) -> Path:
        return FOLDER / self.operator / f"{self.title.replace(' ', '_')}.py"


_LID = (View(12, 10), np.array([0, -0.9, 0.25]), 2.3)
_BELOW = (("border", "SELECTED"),)
PANELS = (
    Panel("Short Fur", "object.limit_hair_add", head, (SKIN, FUR), HEAD),
    Panel("Long Hair", "object.limit_hair_add", head, (SKIN, HAIR), (HEAD[0], HEAD[1], 4.8)),
    Panel("Grass", "object.limit_hair_add", lawn, (LAWN, GREEN),
          (View(25, 22), np.array([0, 0, 0.15]), 2.9)),
    Panel("Lashes", "object.limit_hair_add", lid, (SKIN, DARK), _LID, _BELOW),
    Panel("Eyebrows", "object.limit_hair_add", lid, (SKIN, DARK), _LID, _BELOW),
    Panel("Scales", "object.limit_points_add", head, (HIDE, SCALY), HEAD),
)  # fmt: skip


def make(folder: Path, samples: int = 24) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{i}.png" for i in range(len(PANELS))]
        for panel, part in zip(PANELS, parts, strict=True):
            draw(panel, part, samples)
        save(composed(parts), folder / "presets.png")


def draw(panel: Panel, path: Path, samples: int) -> None:
    scene.start()
    ob = panel.surface()
    ob.data.shade_smooth()
    of_surface, of_things = panel.colours
    ob.data.materials.append(scene.material("Surface", of_surface, 0.2, 0.6, 0.2))
    add_by_preset(panel)
    things, material = bpy.context.active_object, scene.material("Things", of_things, 0.25)
    if things.type == "CURVES":
        things.data.materials.append(material)
    else:
        socket = things.modifiers[0].node_group.interface.items_tree["Material"]
        things.modifiers[0][socket.identifier] = material
    scene.render(path, *panel.view, PIXELS, samples)


def add_by_preset(panel: Panel) -> None:
    """Calls the operator as it is after a choice of the preset in the sidebar."""
    settings = bpy.context.window_manager.operator_properties_last(panel.operator)
    with bpy.context.temp_override(active_operator=settings):
        bpy.utils.execfile(str(panel.path))
    chosen = {name: getattr(settings, name) for name in settings.keys()}  # noqa: SIM118
    plain = {k: tuple(v) if hasattr(v, "__len__") and not isinstance(v, str) else v
             for k, v in chosen.items()}  # fmt: skip
    area, name = panel.operator.split(".")
    getattr(getattr(bpy.ops, area), name)(**plain | dict(panel.properties), add_subsurf=True)


def add(
    name: str, positions: np.ndarray, columns: int, rows: int | None = None
) -> bpy.types.Object:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(positions.tolist(), [], grid_faces(columns, rows or columns).tolist())
    ob = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    return ob


def composed(parts: list[Path]) -> Image.Image:
    rows = -(-len(parts) // COLUMNS)
    size = (COLUMNS * (PIXELS[0] + GAP) + GAP, rows * (PIXELS[1] + TITLE + GAP) + GAP)
    sheet = Image.new("RGB", size, "white")
    pen = ImageDraw.Draw(sheet)
    for i, (part, panel) in enumerate(zip(parts, PANELS, strict=True)):
        left = GAP + i % COLUMNS * (PIXELS[0] + GAP)
        top = GAP + i // COLUMNS * (PIXELS[1] + TITLE + GAP)
        picture = Image.open(part)
        pen.text((left + PIXELS[0] / 2, top + 4), panel.title, INK, font(16), anchor="ma")
        sheet.paste(picture, (left, top + TITLE), picture)
    return sheet.quantize(192, dither=Image.Dither.NONE)
