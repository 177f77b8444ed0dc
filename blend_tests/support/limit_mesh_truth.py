# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes with attributes of every type, and what Blender's own subdivision makes of them."""

from dataclasses import dataclass

import bpy
import numpy as np
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from mathutils.kdtree import KDTree

BEST = 10  # the quality at which Blender's vertices are on the limit surface
KINDS = {
    "POINT": ("FLOAT", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR", "INT", "BOOLEAN"),
    "CORNER": ("FLOAT", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR", "INT"),
    "FACE": ("FLOAT", "INT", "INT8", "BOOLEAN", "FLOAT_VECTOR"),
    "EDGE": ("FLOAT", "BOOLEAN", "INT"),
}
GROUPS = ("Left", "Few")


def dress(ob: bpy.types.Object, seed: int = 0) -> bpy.types.Object:
    """Adds random values in attributes of every type, two UV maps with seams, vertex groups and
    materials.
    """
    rng, mesh = np.random.default_rng(seed), ob.data
    for domain, kinds in KINDS.items():
        for kind in kinds:
            made = mesh.attributes.new(name_of(domain, kind), kind, domain)
            layout = attributes.LAYOUTS[kind]
            values = rng.uniform(0, 1, len(made.data) * layout.width)
            if layout.dtype is bool:
                values = values < 0.5
            elif layout.dtype is not np.float32:
                values = np.floor(values * 9 - 4)
            made.data.foreach_set(layout.key, values.astype(layout.dtype))
    for i, name in enumerate(("First", "Second")):
        corner_vertex = attributes.read(mesh, ids.CORNER_VERTEX)
        uv = rng.uniform(0, 1, (len(mesh.vertices), 2))[corner_vertex]
        apart = np.repeat(rng.uniform(size=len(mesh.polygons)) < 0.3, attributes.face_sizes(mesh))
        uv[apart] += 1 + i
        mesh.uv_layers.new(name=name)
        attributes.write(mesh, name, "FLOAT2", "CORNER", uv)
    mesh.uv_layers.active = mesh.uv_layers["Second"]
    mesh.uv_layers["First"].active_render = True
    mesh.color_attributes.active_color = mesh.color_attributes[name_of("CORNER", "BYTE_COLOR")]
    for group in GROUPS:
        ob.vertex_groups.new(name=group)
    for vertex in range(len(mesh.vertices)):
        ob.vertex_groups["Left"].add([vertex], rng.uniform(), "REPLACE")
    ob.vertex_groups["Few"].add([0, 3], 0.75, "REPLACE")
    for name in ("Red", "Blue", "Own"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", rng.integers(0, 3, len(mesh.polygons)))
    mesh.edges.foreach_set("use_seam", rng.uniform(size=len(mesh.edges)) < 0.4)
    return ob


def name_of(domain: str, kind: str) -> str:
    return f"{domain} {kind}".lower()


def make(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    scenes.activate(ob)
    assert bpy.ops.object.limit_mesh(**properties) == {"FINISHED"}
    made = bpy.context.active_object
    assert made != ob
    return made


def bytes_of(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """Returns colours of 8 bits as they are stored."""
    data = mesh.attributes[name].data
    values = np.empty(4 * len(data), np.float32)
    data.foreach_get("color_srgb", values)
    return np.rint(255 * values).reshape(-1, 4)


def corner_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    return attributes.read(mesh, ids.CORNER_VERTEX)


def corner_normals(mesh: bpy.types.Mesh) -> np.ndarray:
    """Returns the normals of corners as Blender shows them."""
    values = np.empty(3 * len(mesh.loops), np.float32)
    mesh.corner_normals.foreach_get("vector", values)
    return values.reshape(-1, 3)


def weights(ob: bpy.types.Object, mesh: bpy.types.Mesh) -> np.ndarray:
    """Returns weights (vertices, groups)."""
    values = np.zeros((len(mesh.vertices), len(ob.vertex_groups)))
    for i, vertex in enumerate(mesh.vertices):
        for element in vertex.groups:
            values[i, element.group] = element.weight
    return values


@dataclass
class Matched:
    """For each polygon, and each corner, of one mesh the number that it has in another mesh with
    the same polygons.
    """

    polygon: np.ndarray
    corner: np.ndarray

    def rows(self, domain: str, mesh: bpy.types.Mesh, other: bpy.types.Mesh):
        """Yields pairs of elements, one of each mesh."""
        if domain == "FACE":
            return np.arange(len(self.polygon)), self.polygon
        if domain == "CORNER":
            return np.arange(len(self.corner)), self.corner
        of_corner = ids.CORNER_VERTEX if domain == "POINT" else ids.CORNER_EDGE
        return attributes.read(mesh, of_corner), attributes.read(other, of_corner)[self.corner]


def match(mesh: bpy.types.Mesh, other: bpy.types.Mesh) -> Matched:
    """Matches quads by the places of their corners; everything else is compared afterwards."""
    here, there = (_quads(each) for each in (mesh, other))
    assert len(here) == len(there)
    tree = KDTree(len(there))
    for i, centre in enumerate(there.mean(axis=1)):
        tree.insert(centre, i)
    tree.balance()
    polygon = np.array([tree.find(centre)[1] for centre in here.mean(axis=1)])
    assert len(np.unique(polygon)) == len(polygon)
    apart = np.linalg.norm(here[:, :, None] - there[polygon][:, None], axis=3)
    turn = apart.argmin(axis=2)
    assert apart.min(axis=2).max() < 1e-5
    np.testing.assert_array_equal((turn - turn[:, :1]) % 4, np.tile(np.arange(4), (len(turn), 1)))
    return Matched(polygon, (4 * polygon[:, None] + turn).ravel())


def _quads(mesh: bpy.types.Mesh) -> np.ndarray:
    assert (attributes.face_sizes(mesh) == 4).all()
    return attributes.read(mesh, "position")[corner_vertices(mesh)].reshape(-1, 4, 3)
