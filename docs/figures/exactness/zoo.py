# SPDX-License-Identifier: Apache-2.0
"""A mesh for each feature that makes a limit surface hard to evaluate.

Each shows its one feature and as little else as possible. Where the mesh has corners that are not
the subject, they are pinned, because OpenSubdiv is exact there.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.reading import attributes

from figures.meshes.shapes import Faces, cubes, fan, plateau, raised, ridge, sheet, taken
from figures.rendering.scene import View


@dataclass(frozen=True)
class Feature:
    title: str
    positions: np.ndarray
    faces: Faces
    focus: tuple[float, ...]  # the close-up looks at the surface nearest to it, by x and y or all
    overview: View = View(25, 42)
    close: View = View(25, 62)
    extent: float = 0.4  # how much is seen from side to side of the close-up, in mean edges
    lines: int = 32  # parameter lines along each side of a quad in the close-up
    levels: int = 8  # of subdivision in the close-up
    shift: tuple[float, float] = (0, 0)  # from the close-up's middle to the focus, in its widths
    keep_corners: bool = True
    crease: float = 0  # as in Blender, of all edges between the vertices of `creased`
    creased: np.ndarray = field(default_factory=lambda: np.zeros(0, int))
    vertex_crease: float = 0
    creased_vertices: np.ndarray = field(default_factory=lambda: np.zeros(0, int))
    uvs: np.ndarray | None = None  # of all face corners: the picture shows the map, not the mesh


def interior() -> Feature:
    positions, faces = fan(5, 2, 2 * np.pi)
    return Feature("an extraordinary vertex inside the mesh", positions, faces, (0, 0))


def boundary() -> Feature:
    positions, faces = fan(5, 2, np.pi)
    return Feature(
        "an extraordinary vertex on the open boundary",
        positions,
        faces,
        (0, 0),
        extent=0.6,
        shift=(-0.1, -0.3),
        lines=64,
        overview=View(25, 60),
    )


def corner() -> Feature:
    positions, faces = sheet(3, 3)
    return Feature(
        "a smooth corner",
        positions,
        faces,
        (1.5, -1.5),
        close=View(45, 80),
        extent=0.12,
        lines=128,
        levels=9,
        shift=(0, -0.2),
        keep_corners=False,
    )


def polygons() -> Feature:
    """A hexagon, squares and triangles: the middle of a rhombitrihexagonal tiling."""
    turn = np.arange(6) * np.pi / 3
    inner = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    out = np.stack([np.cos(turn + np.pi / 6), np.sin(turn + np.pi / 6)], axis=1)
    flat = np.concatenate([inner, inner + out, np.roll(inner, -1, axis=0) + out])
    faces = [tuple(range(6))]
    faces += [(i, 6 + i, 12 + i, (i + 1) % 6) for i in range(6)]
    faces += [(i, 12 + (i - 1) % 6, 6 + i) for i in range(6)]
    positions = raised(flat)
    return Feature("triangles and larger faces", positions, faces, (0, 0), extent=0.5)


def semisharp() -> Feature:
    positions, faces = sheet(4, 3, ridge)
    return Feature(
        "a semi-sharp crease",
        positions,
        faces,
        (0, -0.5),
        crease=0.6,
        creased=on_ridge(positions),
    )


def crease() -> Feature:
    positions, faces = sheet(3, 3, plateau)
    return Feature(
        "corners of an infinitely sharp crease",
        positions,
        faces,
        (1 / 3, -1 / 3),
        crease=1,
        creased=np.flatnonzero(np.abs(positions[:, :2]).max(axis=1) < 1),
    )


def dart() -> Feature:
    positions, faces = sheet(4, 4, ridge)
    along = on_ridge(positions)
    return Feature(
        "a dart: a sharp crease ends inside the mesh",
        positions,
        faces,
        (0, 0),
        crease=1,
        extent=0.25,
        lines=64,
        creased=along[positions[along, 1] < 0.1],
    )


def cone() -> Feature:
    positions, faces = fan(5, 2, 2 * np.pi, lambda x, y: 0.9 * np.exp(-((x**2 + y**2) / 0.4)))
    return Feature(
        "a sharp vertex",
        positions,
        faces,
        (0, 0),
        View(25, 50),
        View(25, 55),
        vertex_crease=1,
        creased_vertices=nearest(positions)[None],
    )


def several() -> Feature:
    """A cube with another on each side: of the four vertices of each outer face two are of valence
    6 and two of valence 3, or all four of valence 3."""
    positions, faces = cubes(np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)]))
    return Feature(
        "several extraordinary vertices on one face",
        positions,
        faces,
        (0.5, -0.5, 0.5),
        View(35, 32),
        View(45, 36),
    )


def pole() -> Feature:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
    positions, faces = taken()
    return Feature(
        "a pole of sixteen triangles",
        positions,
        faces,
        (0, 0, 1),
        overview=View(25, 55),
        close=View(25, 80),
        extent=1,
        levels=7,
    )


def uv() -> Feature:
    """The map of a fan, cut open along a spoke: the seam ends at an extraordinary vertex."""
    positions, faces = fan(5, 2, 2 * np.pi)
    flat = positions[np.array(faces), :2]  # (faces, 4, 2)
    middle = _angle(flat.mean(axis=1))[:, None]
    turn = middle + np.remainder(_angle(flat) - middle + np.pi, 2 * np.pi) - np.pi
    reach = np.linalg.norm(flat, axis=2)
    turn = np.where(reach < 0.1, 0, turn * 0.85 + 0.25)
    unfolded = 0.5 + 0.2 * reach[..., None] * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    return Feature(
        "the end of a UV seam",
        positions,
        faces,
        (0.5, 0.5),
        View(0, 90),
        View(0, 90),
        extent=0.6,
        uvs=unfolded.reshape(-1, 2),
    )


def _angle(flat: np.ndarray) -> np.ndarray:
    return np.remainder(np.arctan2(flat[..., 1], flat[..., 0]), 2 * np.pi)


FEATURES: dict[str, Callable[[], Feature]] = {
    f.__name__: f
    for f in (
        interior,
        boundary,
        corner,
        polygons,
        several,
        pole,
        semisharp,
        crease,
        dart,
        cone,
        uv,
    )
}


def add(feature: Feature) -> bpy.types.Object:
    """A new object with a Subdivision Surface modifier as Blender makes one."""
    mesh = bpy.data.meshes.new("Cage")
    mesh.from_pydata(feature.positions, [], feature.faces)
    ends = attributes.read(mesh, ids.EDGE_VERTICES)
    between = np.isin(ends, feature.creased).all(axis=1)
    mesh.edge_creases_ensure().data.foreach_set(
        "value", np.where(between, feature.crease, 0).astype(np.float32)
    )
    held = np.isin(np.arange(len(mesh.vertices)), feature.creased_vertices)
    mesh.vertex_creases_ensure().data.foreach_set(
        "value", np.where(held, feature.vertex_crease, 0).astype(np.float32)
    )
    if feature.uvs is not None:
        layer = mesh.uv_layers.new(name="UV")
        layer.data.foreach_set("uv", feature.uvs.astype(np.float32).ravel())
    ob = bpy.data.objects.new("Cage", mesh)
    bpy.context.collection.objects.link(ob)
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    if feature.keep_corners:
        subsurf.boundary_smooth = "PRESERVE_CORNERS"
    return ob


def on_ridge(positions: np.ndarray) -> np.ndarray:
    return np.flatnonzero(np.abs(positions[:, 0]) < 0.1)


def nearest(positions: np.ndarray, place: tuple[float, ...] = (0, 0)) -> np.intp:
    """The point nearest to a place, of which only the first coordinates may be given."""
    return np.linalg.norm(positions[:, : len(place)] - place, axis=1).argmin()
