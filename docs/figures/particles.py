# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/particles.md: the same hair as particles by Blender's own conversion and by
object.limit_particles_from_hair, and how far the keys are from the strands.
"""

import tempfile
from pathlib import Path

import bpy
import numpy as np
from limit_surface.reading import attributes
from PIL import Image

from figures.meshes import obj
from figures.plots import plt
from figures.plots import save as save_plot
from figures.rendering import scene
from figures.rendering.quiet import quiet
from figures.rendering.scene import View
from figures.rendering.sheet import row_of_panels, save

LEVEL, STRANDS, KEYS = 2, 220, 9
LENGTH, RADIUS = 0.32, 0.007
VIEW, MIDDLE, WIDTH = View(20, 24), np.array([-0.05, -0.2, 0.62]), 3.1
PIXELS = (400, 270)
SHEET, HAIR = (0.16, 0.27, 0.55), (0.42, 0.21, 0.08)

CURVES, BLENDERS, OURS = "hair", "Convert to Particle System", "limit_particles_from_hair"


def make(folder: Path, samples: int = 24) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        panels, distances = [], {}
        for title in (CURVES, BLENDERS, OURS):
            path = Path(temporary) / f"{title}.png"
            distances[title] = _draw(title, path, samples)
            panels.append(Image.open(path))
        row = row_of_panels(panels, (CURVES, BLENDERS, OURS), 10).sheet
        plot = Path(temporary) / "plot.png"
        _plot(distances, row.width, plot)
        below = Image.open(plot).convert("RGB")
        sheet = Image.new("RGB", (row.width, row.height + below.height), "white")
        sheet.paste(row, (0, 0))
        sheet.paste(below, (0, row.height))
        save(sheet, folder / "particles.png")


def _draw(title: str, path: Path, samples: int) -> np.ndarray:
    """Renders one panel, and returns the distances of the keys (strands, keys) from the strands'
    points, as shares of the mesh's diagonal.
    """
    scene.start()
    ob, hair = groom()
    distances = np.zeros((STRANDS, KEYS))
    if title != CURVES:
        with quiet():
            convert(title, ob, hair)
        size = np.linalg.norm(np.ptp(attributes.read(ob.data, "position"), axis=0))
        strands = attributes.read(hair.data, "position").reshape(STRANDS, KEYS, 3)
        distances = np.linalg.norm(drawn(ob) - strands, axis=2) / size
        hair.hide_render = True
    scene.render(path, VIEW, MIDDLE, WIDTH, PIXELS, samples)
    return distances


def groom() -> tuple[bpy.types.Object, bpy.types.Object]:
    """Adds a mesh that is shown on its limit surface, with combed hair."""
    positions, faces = obj.read(obj.CROSS)
    mesh = bpy.data.meshes.new("Cross")
    mesh.from_pydata(positions, [], faces)
    ob = bpy.data.objects.new("Cross", mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.levels = subsurf.render_levels = LEVEL
    mesh.shade_smooth()
    mesh.materials.append(scene.material("Sheet", SHEET, 0.25, 0.6, 0.2))
    bpy.ops.object.limit_hair_add(
        distribution="BLUE_NOISE", count=STRANDS, length=LENGTH, points=KEYS, radius=RADIUS,
        seed=3, follow="NONE",
    )  # fmt: skip
    hair = bpy.context.active_object
    strands = attributes.read(hair.data, "position").reshape(-1, KEYS, 3)
    strands[:, :, 1] -= 0.5 * LENGTH * np.linspace(0, 1, KEYS) ** 2
    hair.data.points.foreach_set("position", strands.ravel())
    hair.data.materials.append(scene.material("Hair", HAIR, scene.GLOW))
    mesh.materials.append(hair.data.materials[0])
    return ob, hair


def convert(how: str, ob: bpy.types.Object, hair: bpy.types.Object) -> None:
    if how == OURS:
        bpy.ops.object.limit_particles_from_hair()
    else:
        bpy.ops.curves.convert_to_particle_system()
    settings = ob.particle_systems[0].settings
    settings.material, settings.render_type, settings.display_step = 2, "PATH", 3
    settings.radius_scale, settings.root_radius, settings.tip_radius = 2 * RADIUS, 1.0, 1.0
    settings.use_close_tip = False


def drawn(ob: bpy.types.Object) -> np.ndarray:
    """Returns the strands (n, KEYS, 3) that Blender draws for the particles."""
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).particle_systems[0]
    return np.array(
        [
            [shown.co_hair(ob, particle_no=i, step=j) for j in range(KEYS)]
            for i in range(len(shown.particles))
        ]
    )


def _plot(distances: dict[str, np.ndarray], width: int, path: Path) -> None:
    figure, axes = plt.subplots(figsize=(width / 100, 2.6), layout="constrained")
    keys = np.arange(KEYS)
    for title, colour in ((BLENDERS, "#b5651d"), (OURS, "#29468c")):
        away = distances[title]
        axes.fill_between(keys, away.min(axis=0), away.max(axis=0), color=colour, alpha=0.2)
        label = f"{title}: at most {away.max():.0e}"
        axes.plot(keys, away.mean(axis=0), "o-", color=colour, ms=4, label=label)
    axes.set_yscale("log")
    axes.set_xlabel("key, from the root to the tip")
    axes.set_ylabel("distance / diagonal")
    axes.set_title("Distance of the keys from the points of the hair: mean and range", fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=9, loc="center right")
    save_plot(figure, path, dpi=100)
