# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/snap.md: objects and hair before and after object.limit_snap."""

import tempfile
from collections.abc import Callable
from pathlib import Path

import bpy
import limitsurf
import numpy as np
from limit_surface.reading import attributes
from PIL import Image, ImageDraw

from figures.meshes.grids import grid_faces
from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import INK, font, save

PIXELS = (330, 270)
GAP, TITLE = 10, 30
VIEW, MIDDLE, WIDTH = View(28, 36), np.array([0, 0, 0.2]), 3.75
SIDE = 4  # faces along each side of the sheet
SHEET = (0.42, 0.47, 0.56)
PIN, HAIR = (0.75, 0.17, 0.06), (0.25, 0.07, 0.02)
POINTS = 9  # of a strand

PANELS: tuple[tuple[str, str, dict[str, str] | None], ...] = (
    ("pins", "Before", None),
    ("pins", "Align: None", {"align": "NONE"}),
    ("pins", "Align: Normal", {"align": "NORMAL"}),
    ("pins", "Align: Normal and U", {"align": "NORMAL_DU"}),
    ("hair", "Before", None),
    ("hair", "Hair: Root", {"hair": "ROOT"}),
    ("hair", "Hair: Strand", {"hair": "STRAND"}),
    ("hair", "Hair: Blend", {"hair": "BLEND"}),
)
COLUMNS = 4


def make(folder: Path, samples: int = 24) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        parts = [Path(temporary) / f"{i}.png" for i in range(len(PANELS))]
        for part, (what, _title, properties) in zip(parts, PANELS, strict=True):
            draw(what, properties, part, samples)
        save(composed(parts), folder / "snap.png")


def draw(what: str, properties: dict[str, str] | None, path: Path, samples: int) -> None:
    scene.start()
    cage = add_cage()
    bpy.ops.object.select_all(action="DESELECT")
    ADD[what]()
    bpy.context.view_layer.objects.active = cage
    bpy.context.view_layer.update()
    if properties is not None:
        bpy.ops.object.limit_snap(**properties)
    cage.hide_render = True
    add_limit(cage)
    scene.render(path, VIEW, MIDDLE, WIDTH, PIXELS, samples)


def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.55 * np.sin(1.5 * x) * np.cos(1.2 * y)


def add_cage() -> bpy.types.Object:
    """The control mesh: an open sheet."""
    y, x = np.mgrid[: SIDE + 1, : SIDE + 1].reshape(2, -1) * 3 / SIDE - 1.5
    faces = grid_faces(SIDE, SIDE)
    mesh = bpy.data.meshes.new("Cage")
    mesh.from_pydata(np.stack([x, y, height(x, y)], axis=1), [], faces.tolist())
    ob = bpy.data.objects.new("Cage", mesh)
    bpy.context.collection.objects.link(ob)
    return ob


def add_limit(cage: bpy.types.Object) -> None:
    surface = limitsurf.LimitSurface(
        limitsurf.ControlMesh.from_faces(
            [vertex.co[:] for vertex in cage.data.vertices],
            [polygon.vertices[:] for polygon in cage.data.polygons],
        )
    )
    fine = surface.tessellate(5)
    colours = np.broadcast_to(SHEET, fine.positions.shape)
    scene.add_surface(fine.faces, fine.positions, colours)


def spots(count: int, seed: int, apart: float) -> np.ndarray:
    """Random places above and below the sheet, none close to another."""
    rng, found = np.random.default_rng(seed), np.empty((0, 3))
    while len(found) < count:
        x, y = rng.uniform(-1.25, 1.25, 2)
        if (np.linalg.norm(found[:, :2] - (x, y), axis=1) > apart).all():
            found = np.vstack([found, (x, y, height(x, y) + rng.uniform(0.1, 0.5))])
    return found


def add_pins() -> None:
    """Arrows: a shaft along Z, and a bar that points along X at its foot."""
    mesh = bpy.data.meshes.new("Pin")
    vertices, faces = [], []
    for low, high in (((-0.03, -0.03, 0), (0.03, 0.03, 0.42)), ((0, -0.03, 0), (0.24, 0.03, 0.06))):
        corners = np.array(np.meshgrid(*np.transpose([low, high]), indexing="ij")).reshape(3, -1).T
        k = len(vertices)
        vertices += corners.tolist()
        for face in (
            (0, 1, 3, 2),
            (4, 6, 7, 5),
            (0, 4, 5, 1),
            (2, 3, 7, 6),
            (0, 2, 6, 4),
            (1, 5, 7, 3),
        ):
            faces.append([k + i for i in face])
    mesh.from_pydata(vertices, [], faces)
    mesh.materials.append(scene.material("Pin", PIN, glow=scene.GLOW))
    rng = np.random.default_rng(2)
    for spot in spots(13, 4, 0.55):
        ob = bpy.data.objects.new("Pin", mesh)
        ob.location, ob.rotation_euler = spot, (*rng.uniform(-0.3, 0.3, 2), rng.uniform(0, 6.3))
        bpy.context.collection.objects.link(ob)
        ob.select_set(True)


def add_hair() -> None:
    """Curls whose roots are above the sheet."""
    rng = np.random.default_rng(3)
    roots = spots(30, 5, 0.36)
    along = np.linspace(0, 1, POINTS)
    turn = rng.uniform(0, 2 * np.pi, (len(roots), 1))
    bend = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=-1) * (along**2)[None, :, None]
    points = roots[:, None] + 0.6 * along[None, :, None] * [0, 0, 1] + 0.25 * bend
    curves = bpy.data.hair_curves.new("Hair")
    curves.add_curves([POINTS] * len(roots))
    curves.points.foreach_set("position", points.astype(np.float32).ravel())
    attributes.write(curves, "radius", "FLOAT", "POINT", np.full(points.size // 3, 0.013))
    curves.materials.append(scene.material("Hair", HAIR, glow=scene.GLOW))
    ob = bpy.data.objects.new("Hair", curves)
    bpy.context.collection.objects.link(ob)
    ob.select_set(True)


ADD: dict[str, Callable[[], None]] = {"pins": add_pins, "hair": add_hair}


def composed(parts: list[Path]) -> Image.Image:
    rows = -(-len(parts) // COLUMNS)
    size = (
        COLUMNS * (PIXELS[0] + GAP) + GAP,
        rows * (PIXELS[1] + TITLE + GAP) + GAP,
    )
    sheet = Image.new("RGB", size, "white")
    pen = ImageDraw.Draw(sheet)
    for i, (part, (_what, title, _properties)) in enumerate(zip(parts, PANELS, strict=True)):
        left = GAP + i % COLUMNS * (PIXELS[0] + GAP)
        top = GAP + i // COLUMNS * (PIXELS[1] + TITLE + GAP)
        picture = Image.open(part)
        pen.text((left + PIXELS[0] / 2, top + 4), title, INK, font(16), anchor="ma")
        sheet.paste(picture, (left, top + TITLE), picture)
    return sheet.quantize(128, dither=Image.Dither.NONE)
