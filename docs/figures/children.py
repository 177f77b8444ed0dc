# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/children.md: the same guides with children by Blender's own node group and by
object.limit_children_add, and how far their roots are from the limit surface.
"""

import tempfile
from pathlib import Path

import bpy
import limitsurf
import numpy as np
from limit_surface.reading import attributes, cage
from PIL import Image

from figures import NotDrawnError
from figures.meshes import obj
from figures.plots import plt
from figures.plots import save as save_plot
from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import row_of_panels, save

LEVEL = 2  # of the mesh that Blender subdivides
GUIDES, CHILDREN, POINTS = 60, 4000, 8
LENGTH, RADIUS = 0.16, 0.0016
VIEW, MIDDLE, WIDTH = View(12, 4), np.array([-0.3, -1.0, 0.5]), 0.8
PIXELS = (520, 330)
SHEET, HAIR = (0.16, 0.27, 0.55), (0.42, 0.21, 0.08)
FINE = 6  # level of the drawn polygons on the limit surface

OURS, BLENDERS = "object.limit_children_add", "Interpolate Hair Curves"


def make(folder: Path, samples: int = 24) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        panels, distances = [], {}
        for title in (BLENDERS, OURS):
            path = Path(temporary) / f"{title}.png"
            distances[title] = _draw(title, path, samples)
            panels.append(Image.open(path))
        row = row_of_panels(panels, (BLENDERS, OURS), 10).sheet
        plot = Path(temporary) / "plot.png"
        _plot(distances, row.width, plot)
        below = Image.open(plot).convert("RGB")
        sheet = Image.new("RGB", (row.width, row.height + below.height), "white")
        sheet.paste(row, (0, 0))
        sheet.paste(below, (0, row.height))
        save(sheet, folder / "children.png")


def _draw(title: str, path: Path, samples: int) -> np.ndarray:
    """Renders one panel, and returns x and the distance from the limit surface of each root, as
    shares of the mesh's diagonal; the distance is negative inside.
    """
    scene.start()
    ob, guides = groom()
    if title == OURS:
        bpy.ops.object.limit_children_add(
            distribution="UNIFORM", count=CHILDREN, points=POINTS, radius=RADIUS, seed=1,
            follow="NONE",
        )  # fmt: skip
        hair = bpy.context.active_object
        guides.hide_render = True
    else:
        hair = interpolated(ob, guides)
    distances = distances_of(ob, hair)
    hair.data.materials.clear()
    hair.data.materials.append(scene.material("Hair", HAIR, glow=scene.GLOW))
    ob.hide_render = True
    fine = surface_of(ob).tessellate(FINE)
    scene.add_surface(fine.faces, fine.positions, np.broadcast_to(SHEET, fine.positions.shape))
    scene.render(path, VIEW, MIDDLE, WIDTH, PIXELS, samples)
    return distances


def groom() -> tuple[bpy.types.Object, bpy.types.Object]:
    """Adds a mesh, and guides on it that are combed forwards."""
    positions, faces = obj.read(obj.CROSS)
    mesh = bpy.data.meshes.new("Cross")
    mesh.from_pydata(positions, [], faces)
    # Blender's node group finds places by the UV map
    uv = mesh.uv_layers.new(name="Flat").data
    low, high = positions.min(axis=0), positions.max(axis=0)
    flat = (positions[attributes.read(mesh, ".corner_vert")] - low) / (high - low)
    uv.foreach_set("uv", flat[:, :2].astype(np.float32).ravel())
    ob = bpy.data.objects.new("Cross", mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.levels = subsurf.render_levels = LEVEL
    bpy.ops.object.limit_hair_add(
        distribution="BLUE_NOISE", count=GUIDES, length=LENGTH, points=POINTS, radius=RADIUS,
        random=0.25, seed=3, follow="NONE",
    )  # fmt: skip
    guides = bpy.context.active_object
    strands = attributes.read(guides.data, "position").reshape(-1, POINTS, 3)
    strands[:, :, 1] -= 0.6 * LENGTH * np.linspace(0, 1, POINTS) ** 2
    guides.data.points.foreach_set("position", strands.ravel())
    return ob, guides


def interpolated(ob: bpy.types.Object, guides: bpy.types.Object) -> bpy.types.Object:
    """Puts Blender's own children on the guides, about as many."""
    assets = Path(bpy.utils.resource_path("LOCAL"), "datafiles/assets/geometry_nodes")
    library = assets / "procedural_hair_node_assets.blend"
    if not library.exists():
        raise NotDrawnError("this Blender comes without its hair assets")
    with bpy.data.libraries.load(str(library)) as (_, wanted):
        wanted.node_groups = [BLENDERS]
    group = bpy.data.node_groups[BLENDERS]
    group.is_modifier = True
    modifier = guides.modifiers.new(BLENDERS, "NODES")
    modifier.node_group = group
    inputs = [item for item in group.interface.items_tree if item.item_type == "SOCKET"]
    keys = {(i.name, i.socket_type): i.identifier for i in inputs if i.in_out == "INPUT"}
    modifier[keys["Surface", "NodeSocketObject"]] = ob
    uv = keys["Surface UV Map", "NodeSocketVector"]
    modifier[f"{uv}_use_attribute"], modifier[f"{uv}_attribute_name"] = True, "Flat"
    modifier[keys["Poisson Disk Distribution", "NodeSocketBool"]] = False
    modifier[keys["Follow Surface Normal", "NodeSocketBool"]] = True
    area = surface_of(ob).area()
    modifier[keys["Density", "NodeSocketFloat"]] = CHILDREN / area
    guides.update_tag()
    return guides


def distances_of(ob: bpy.types.Object, hair: bpy.types.Object) -> np.ndarray:
    depsgraph = bpy.context.evaluated_depsgraph_get()
    data = hair.evaluated_get(depsgraph).data
    first = np.empty(len(data.curve_offset_data), np.int32)
    data.curve_offset_data.foreach_get("value", first)
    roots = attributes.read(data, "position")[first[:-1]].astype(np.float64)
    size = np.linalg.norm(np.ptp(attributes.read(ob.data, "position"), axis=0))
    hits = surface_of(ob).closest(roots)
    side = np.sign(np.einsum("ni,ni->n", roots - hits.position, hits.normal))
    return np.column_stack([roots[:, 0], np.where(side < 0, -1, 1) * hits.distance / size])


def _plot(distances: dict[str, np.ndarray], width: int, path: Path) -> None:
    figure, axes = plt.subplots(figsize=(width / 100, 2.8), layout="constrained")
    for title, colour in ((BLENDERS, "#b5651d"), (OURS, "#29468c")):
        x, away = distances[title].T
        label = f"{title}: at most {np.abs(away).max():.0e}"
        axes.plot(x, 1000 * away, ".", color=colour, ms=2.5, label=label)
    axes.set_xlabel("x of the root")
    axes.set_ylabel("distance / diagonal · 1000")
    axes.set_title("Distance of the roots from the limit surface", fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=9, loc="lower left", markerscale=4)
    save_plot(figure, path, dpi=100)


def surface_of(ob: bpy.types.Object) -> limitsurf.LimitSurface:
    return cage.read(ob, bpy.context.evaluated_depsgraph_get()).surface()
