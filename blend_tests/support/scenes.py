# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects for tests, and functions that look at them."""

from collections.abc import Callable, Sequence
from pathlib import Path

import bpy
import limitsurf
import numpy as np
import pytest
from figures.meshes import grids, obj
from figures.parity import zoo
from limit_surface import ids
from limit_surface.reading import attributes

BOUNDARIES = {"ALL": "smooth", "PRESERVE_CORNERS": "corners"}


def slow(*cases: object) -> list[object]:
    """Returns the cases of a parametrized test that run only with --slow; tuples are several
    parameters.
    """
    parameters = [case if isinstance(case, tuple) else (case,) for case in cases]
    return [pytest.param(*each, marks=pytest.mark.slow) for each in parameters]


def add_mesh(
    name: str,
    positions: np.ndarray | Sequence[Sequence[float]],
    faces: Sequence[Sequence[int]],
    edges: Sequence[tuple[int, int]] = (),
) -> bpy.types.Object:
    """Adds a new object and makes it active, as a user does."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(positions, edges, faces)
    ob = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    ob.select_set(True)
    return ob


def overridden(folder: Path, *objects: bpy.types.Object) -> list[bpy.types.Object]:
    """Begins another file, with library overrides of these objects and their data."""
    collection = bpy.data.collections.new("Asset")
    names = [ob.name for ob in objects]
    for ob in objects:
        collection.objects.link(ob)
    path = str(folder / "asset.blend")
    bpy.data.libraries.write(path, {collection})
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (_there, here):
        here.collections = ["Asset"]
    here.collections[0].override_hierarchy_create(
        bpy.context.scene, bpy.context.view_layer, do_fully_editable=True
    )
    overrides = [bpy.context.scene.objects[name] for name in names]
    for ob in overrides:
        if ob.data.library:
            ob.data.override_create(remap_local_usages=True)
    return overrides


def spoil_edge_selection(mesh: bpy.types.Mesh) -> None:
    """Stores which edges are selected as Blender 5.0 does where it has made the edges itself: with
    the type of another attribute. There it crashes when a script selects edges afterwards.
    """
    mesh.attributes.remove(mesh.attributes[ids.EDGE_SELECTION])
    ends = attributes.read(mesh, ids.EDGE_VERTICES)
    attributes.write(mesh, ids.EDGE_SELECTION, "INT32_2D", "EDGE", ends)


def cross() -> bpy.types.Object:
    return add_mesh("Cross", *obj.read(obj.CROSS))


def grid_with_holes() -> bpy.types.Object:
    """Adds 5 x 4 quads on a bent sheet without two of them, so that it has corners of 1, 2 and 3
    faces.
    """
    positions = [(x, y, 0.3 * np.sin(1.3 * x) + 0.2 * y * y) for y in range(5) for x in range(6)]
    faces = np.delete(grids.grid_faces(5, 4), [6, 13], axis=0)
    return add_mesh("Holes", positions, faces.tolist())


def flat_grid(side: int) -> bpy.types.Object:
    """Adds squares of size 1. Away from the border the limit surface is the mesh itself."""
    y, x = np.mgrid[: side + 1, : side + 1].reshape(2, -1)
    faces = grids.grid_faces(side, side)
    return add_mesh("Flat", np.stack([x, y, 0 * x], axis=1), faces.tolist())


def mixed_polygons() -> bpy.types.Object:
    """Adds a triangle, a pentagon and quads around a vertex, with an open boundary."""
    return add_mesh("Mixed", *zoo.polygons())


def monkey() -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    return bpy.context.active_object


SCENES: dict[str, Callable[[], bpy.types.Object]] = {
    "cross": cross,
    "grid with holes": grid_with_holes,
    "mixed polygons": mixed_polygons,
    "monkey": monkey,
}
#: For tests in which the monkey, the largest mesh, takes many seconds: there it is a slow case.
SMALL_FIRST = [*(name for name in SCENES if name != "monkey"), *slow("monkey")]


def add_subsurf(ob: bpy.types.Object, boundary: str = "ALL") -> bpy.types.SubsurfModifier:
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.boundary_smooth = boundary
    return subsurf


def add_uv_map(ob: bpy.types.Object, affine: Callable[[np.ndarray], np.ndarray]) -> None:
    """Adds a UV map that is a function of the vertices' positions."""
    layer = ob.data.uv_layers.new(name="Flat")
    corners = attributes.read(ob.data, ids.CORNER_VERTEX)
    positions = attributes.read(ob.data, "position")[corners]
    layer.data.foreach_set("uv", affine(positions).astype(np.float32).ravel())


def activate(ob: bpy.types.Object) -> None:
    bpy.context.view_layer.objects.active = ob


def add_hair(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    activate(ob)
    assert bpy.ops.object.limit_hair_add(**{"per_side": 4} | properties) == {"FINISHED"}
    return bpy.context.active_object


def add_points(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    activate(ob)
    assert bpy.ops.object.limit_points_add(**{"per_side": 4} | properties) == {"FINISHED"}
    return bpy.context.active_object


def strands(hair: bpy.types.Object) -> np.ndarray:
    """Returns control points (strands, points, 3) in the hair's own space."""
    return attributes.read(hair.data, "position").reshape(len(hair.data.curves), -1, 3)


def locations(data: bpy.types.ID) -> tuple[np.ndarray, np.ndarray]:
    return attributes.read(data, ids.FACE), attributes.read(data, ids.UV).astype(np.float64)


def ptex_corners(ob: bpy.types.Object, corner_values: np.ndarray) -> np.ndarray:
    """Returns the values at the four corners of every Ptex face, calculated polygon by polygon."""
    found = []
    for polygon in ob.data.polygons:
        p = corner_values[polygon.loop_start : polygon.loop_start + polygon.loop_total]
        n, centre = len(p), p.mean(axis=0)
        if n == 4:
            found.append(p)
            continue
        for i in range(n):
            found.append([p[i], (p[i] + p[(i + 1) % n]) / 2, centre, (p[i] + p[i - 1]) / 2])
    return np.array(found)


def bilinear(ptex: np.ndarray, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
    (u, v), ptex = uv.T[:, :, None], ptex[face]
    weights = ((1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v)
    return sum(weight * ptex[:, i] for i, weight in enumerate(weights))


def on_base_mesh(ob: bpy.types.Object, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
    corner_vertex = attributes.read(ob.data, ids.CORNER_VERTEX)
    positions = attributes.read(ob.data, "position").astype(np.float64)
    return bilinear(ptex_corners(ob, positions[corner_vertex]), face, uv)


def surface_without_addon(ob: bpy.types.Object, boundary: str = "ALL") -> limitsurf.LimitSurface:
    """Returns the limit surface of the mesh that Blender shows once all Subdivision modifiers are
    disabled, with the creases of that mesh unless the first modifier ignores creases.
    """
    subsurfs = [m for m in ob.modifiers if m.type == "SUBSURF"]
    shown = [m.show_viewport for m in ob.modifiers]
    for modifier in list(ob.modifiers)[ob.modifiers.find(subsurfs[0].name) if subsurfs else 0 :]:
        modifier.show_viewport = False
    mesh = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    faces = [list(polygon.vertices) for polygon in mesh.polygons]
    positions = np.array([vertex.co for vertex in mesh.vertices], np.float64)
    edges = np.array([edge.vertices for edge in mesh.edges]).reshape(-1, 2)
    edge_sharpness, vertex_sharpness = _sharpness(mesh, edges)
    for modifier, was in zip(ob.modifiers, shown, strict=True):
        modifier.show_viewport = was
    if subsurfs and not subsurfs[0].use_creases:
        edge_sharpness, vertex_sharpness = 0 * edge_sharpness, 0 * vertex_sharpness
    cage = limitsurf.ControlMesh.from_faces(
        positions,
        faces,
        edge_sharpness=(edges, edge_sharpness),
        vertex_sharpness=(np.arange(len(positions)), vertex_sharpness),
        boundary=BOUNDARIES[boundary],
    )
    return limitsurf.LimitSurface(cage)


def _sharpness(mesh: bpy.types.Mesh, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the sharpness of edges and vertices by Blender's rules: a crease c means 10 c^2, and
    a vertex at which two edges meet gets the smaller sharpness of these in addition to its own.
    """
    edge, vertex = (
        10.0 * attributes.read(mesh, name).astype(np.float64) ** 2
        if name in mesh.attributes
        else np.zeros(count)
        for name, count in (
            ("crease_edge", len(mesh.edges)),
            ("crease_vert", len(mesh.vertices)),
        )
    )
    for corner in np.flatnonzero(np.bincount(edges.ravel(), minlength=len(vertex)) == 2):
        least = edge[(edges == corner).any(axis=1)].min()
        vertex[corner] = min(10, vertex[corner] + least)
    return edge, vertex


STRETCHED = {"scale": (0.4, 2.5, 1.0), "rotation_euler": (0.3, 0.2, 1.0), "location": (3, 1, -2)}
MIRRORED = {"scale": (-1.5, 1.0, 0.6), "rotation_euler": (1.0, 0.0, 0.4)}


def place(ob: bpy.types.Object, transform: dict[str, tuple[float, ...]]) -> None:
    """Sets properties of an object's transform."""
    for name, value in transform.items():
        setattr(ob, name, value)
    bpy.context.view_layer.update()


def transformed(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    return points @ np.array(matrix)[:3, :3].T + np.array(matrix)[:3, 3]


def file_contents() -> dict[str, list[str]]:
    """Returns the names of everything in the file, by type."""
    return {kind: sorted(item.name_full for item in getattr(bpy.data, kind)) for kind in kinds()}


def kinds() -> list[str]:
    """Returns the names of the collections of bpy.data, each for one type of data-blocks."""
    found = [p.identifier for p in bpy.data.bl_rna.properties if p.type == "COLLECTION"]
    return [kind for kind in found if kind != "all_ids"]  # since Blender 5.1 one for all types
