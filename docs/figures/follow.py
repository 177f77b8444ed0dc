# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/follow.md: hair on a cross that bends, by object.limit_follow and by
Blender's own node, and the distance of the roots from the limit surface in each frame.
"""

import tempfile
from pathlib import Path

import bpy
import limitsurf
import numpy as np
from limit_surface.reading import attributes, cage
from PIL import Image

from figures.meshes import obj
from figures.plots import plt
from figures.plots import save as save_plot
from figures.rendering import scene
from figures.rendering.scene import View
from figures.rendering.sheet import row_of_panels, save

FRAMES = 24
SHOWN = (1, 9, 17, 24)
BEND = np.radians(110)  # in the last frame
LEVEL = 2  # of the mesh that Blender subdivides
PER_SIDE, LENGTH, RADIUS = 16, 0.3, 0.004
VIEW, MIDDLE, WIDTH = View(24, 38), np.array([0, 0, 0.1]), 3.7
PIXELS = (330, 300)
SHEET, HAIR = (0.16, 0.27, 0.55), (0.42, 0.21, 0.08)
FINE = 5  # level of the drawn polygons on the limit surface

OURS, BLENDERS = "Follow Limit Surface", "Deform Curves on Surface"


def make(folder: Path, samples: int = 24) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        rows, distances = [], {}
        for title in (OURS, BLENDERS):
            parts, distances[title] = _play(title, Path(temporary), samples)
            titles = [f"{title}, frame {frame}" for frame in SHOWN]
            rows.append(row_of_panels([Image.open(part) for part in parts], titles, 10).sheet)
        plot = Path(temporary) / "plot.png"
        _plot(distances, rows[0].width, plot)
        rows.append(Image.open(plot).convert("RGB"))
        sheet = Image.new("RGB", (rows[0].width, sum(row.height for row in rows)), "white")
        top = 0
        for row in rows:
            sheet.paste(row, (0, top))
            top += row.height
        save(sheet, folder / "follow.png")


def _play(title: str, folder: Path, samples: int) -> tuple[list[Path], list[float]]:
    """Renders the shown frames, and returns the pictures and the roots' largest distance from the
    limit surface in each frame, as a share of the mesh's size at rest.
    """
    scene.start()
    cross = _bending_cross()
    bpy.ops.object.limit_hair_add(
        per_side=PER_SIDE, length=LENGTH, points=6, radius=RADIUS, tilt=(0.3, 0.0), seed=1,
        follow="AUTO" if title == OURS else "NONE",
    )  # fmt: skip
    hair = bpy.context.active_object
    hair.data.materials.append(scene.material("Hair", HAIR, glow=scene.GLOW))
    if title == BLENDERS:
        deform_by_blender(cross, hair)
    cross.hide_render = True
    size = np.linalg.norm(np.ptp(attributes.read(cross.data, "position"), axis=0))
    parts, distances = [], []
    for frame in range(1, FRAMES + 1):
        bpy.context.scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        surface = cage.read(cross, depsgraph).surface()
        strands = attributes.read(hair.evaluated_get(depsgraph).data, "position")
        roots = strands.reshape(len(hair.data.curves), -1, 3)[:, 0]
        distances.append(float(surface.closest(roots).distance.max() / size))
        if frame in SHOWN:
            parts.append(folder / f"{title} {frame}.png")
            _render(surface, parts[-1], samples)
    return parts, distances


def _bending_cross() -> bpy.types.Object:
    positions, faces = obj.read(obj.CROSS)
    mesh = bpy.data.meshes.new("Cross")
    mesh.from_pydata(positions, [], faces)
    # Blender's node finds places by the UV map
    uv = mesh.uv_layers.new(name="Flat").data
    low, high = positions.min(axis=0), positions.max(axis=0)
    corners = attributes.read(mesh, ".corner_vert")
    flat = (positions[corners] - low) / (high - low)
    uv.foreach_set("uv", flat[:, :2].astype(np.float32).ravel())
    ob = bpy.data.objects.new("Cross", mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    bend = ob.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.deform_axis = "BEND", "Y"
    for frame, angle in ((1, 0.0), (FRAMES, BEND)):
        bend.angle = angle
        bend.keyframe_insert("angle", frame=frame)
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.levels = subsurf.render_levels = LEVEL
    bpy.context.scene.frame_set(1)
    return ob


def deform_by_blender(cross: bpy.types.Object, hair: bpy.types.Object) -> None:
    """Binds the hair as Blender does it: its roots at rest are on the bare mesh."""
    bpy.ops.curves.snap_curves_to_surface(attach_mode="NEAREST")
    cross.add_rest_position_attribute = True
    group = bpy.data.node_groups.new(BLENDERS, "GeometryNodeTree")
    group.is_modifier = True
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    nodes = [
        group.nodes.new(name)
        for name in ("NodeGroupInput", "GeometryNodeDeformCurvesOnSurface", "NodeGroupOutput")
    ]
    for before, after in zip(nodes, nodes[1:], strict=False):
        group.links.new(before.outputs[0], after.inputs[0])
    hair.modifiers.new(BLENDERS, "NODES").node_group = group


def _render(surface: limitsurf.LimitSurface, path: Path, samples: int) -> None:
    fine = surface.tessellate(FINE)
    scene.add_surface(fine.faces, fine.positions, np.broadcast_to(SHEET, fine.positions.shape))
    drawn = bpy.context.scene.objects["Surface"]
    scene.render(path, VIEW, MIDDLE, WIDTH, PIXELS, samples)
    bpy.data.batch_remove([drawn.data, drawn])


def _plot(distances: dict[str, list[float]], width: int, path: Path) -> None:
    figure, axes = plt.subplots(figsize=(width / 100, 2.6), layout="constrained")
    frames = np.arange(1, FRAMES + 1)
    for title, colour in ((OURS, "#29468c"), (BLENDERS, "#b5651d")):
        axes.semilogy(frames, distances[title], "o-", color=colour, ms=3, label=title)
    axes.set_xlabel("frame")
    axes.set_ylabel("distance / diagonal")
    axes.set_title("The largest distance of a root from the limit surface", fontsize=10)
    axes.set_xlim(1, FRAMES)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=9, loc="center right")
    save_plot(figure, path, dpi=100)
