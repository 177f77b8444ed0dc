# SPDX-License-Identifier: Apache-2.0
"""Meshes on which Blender's subdivision is compared with the limit surface."""

from collections.abc import Callable, Sequence

import bpy
import numpy as np

from figures.meshes import obj
from figures.meshes.grids import grid_faces

Faces = Sequence[Sequence[int]]


def cross() -> tuple[np.ndarray, Faces]:
    """Five quads, open all around: twelve smooth or pinned corners and four concave vertices."""
    return obj.read(obj.CROSS)


def sheet() -> tuple[np.ndarray, Faces]:
    """5 x 4 quads, two of them missing: boundary vertices of one, two and three faces."""
    columns, rows = 5, 4
    y, x = np.mgrid[: rows + 1, : columns + 1].reshape(2, -1)
    positions = np.stack([x, y, 0.3 * np.sin(1.3 * x) + 0.2 * y * y / (rows + 1)], axis=1)
    faces = np.delete(grid_faces(columns, rows), (6, 13), axis=0).tolist()
    return positions, faces


def polygons() -> tuple[np.ndarray, Faces]:
    """A pentagon, triangles and quads around a vertex, open all around."""
    positions = [
        (0, 0, 0.5), (1, 0, 0.2), (1.1, 1, 0), (0, 1.2, 0.1), (-1, 1, 0), (-1.3, 0.1, 0.2),
        (-0.9, -1, 0), (0, -1.1, 0.3), (1, -1, -0.1), (0.4, 1.9, -0.2),
    ]  # fmt: skip
    faces = [(0, 1, 2, 9, 3), (0, 3, 4, 5), (0, 5, 7), (5, 6, 7), (0, 7, 8, 1)]
    return np.array(positions), faces


def prism() -> tuple[np.ndarray, Faces]:
    """A closed, sloping prism of two pentagons and five quads."""
    angle = 2 * np.pi * np.arange(5) / 5
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    side = [(i, (i + 1) % 5, 5 + (i + 1) % 5, 5 + i) for i in range(5)]
    faces = [tuple(range(4, -1, -1)), tuple(range(5, 10)), *side]
    return np.concatenate([ring, 0.8 * ring + [0.4, 0.1, 1.3]]), faces


def fans() -> tuple[np.ndarray, Faces]:
    """Around each of five boundary vertices a fan of 2 to 6 quads, joined at its sides; two of the
    fans meet in one vertex only."""
    positions: list[Sequence[float]] = []
    faces: list[Sequence[int]] = []
    for fan, count in enumerate((2, 3, 4, 5, 6)):
        first = len(positions)
        angle = np.pi * np.arange(2 * count + 1) / (2 * count)
        reach = np.where(np.arange(2 * count + 1) % 2, 1.3, 1.0)
        rim = np.stack([reach * np.cos(angle), reach * np.sin(angle), 0.2 * np.cos(3 * angle)])
        positions += [(3 * fan, 0, 0.4), *(rim.T + [3 * fan, 0, 0])]
        faces += [
            (first, first + 1 + 2 * i, first + 2 + 2 * i, first + 3 + 2 * i) for i in range(count)
        ]
    # The last two share a corner: the first one's left end is the second one's right end.
    merged = np.arange(len(positions))
    one, other = len(positions) - 15, len(positions) - 13
    merged[other] = one
    return np.array(positions), [merged[list(face)].tolist() for face in faces]


def fin() -> tuple[np.ndarray, Faces]:
    """The sheet, with a third face at one of its edges and another face turned over."""
    positions, faces = sheet()
    faces.append((14, 15, len(positions) + 1, len(positions)))
    faces[5] = faces[5][::-1]
    return np.concatenate([positions, positions[14:16] + [0.1, 0.2, 1]]), faces


def monkey() -> tuple[np.ndarray, Faces]:
    bpy.ops.mesh.primitive_monkey_add()
    ob = bpy.context.active_object
    positions = np.array([vertex.co[:] for vertex in ob.data.vertices])
    faces = [polygon.vertices[:] for polygon in ob.data.polygons]
    bpy.data.objects.remove(ob)
    return positions, faces


MESHES: dict[str, Callable[[], tuple[np.ndarray, Faces]]] = {
    f.__name__: f for f in (cross, sheet, polygons, prism, fans, fin, monkey)
}


def add(name: str, seed: int = 0) -> bpy.types.Object:
    """The mesh as a new object with a Subdivision Surface modifier and a UV map."""
    positions, faces = MESHES[name]()
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(positions, [], faces)
    _add_uv_map(mesh, np.random.default_rng(seed))
    ob = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(ob)
    ob.modifiers.new("Subdivision", "SUBSURF").use_limit_surface = True
    return ob


def _add_uv_map(mesh: bpy.types.Mesh, rng: np.random.Generator) -> None:
    """Three islands, distributed at random over the faces. The seams between them branch and turn
    at random, and end where two islands share the value at a vertex."""
    corner_vertex = _column(mesh.loops, "vertex_index")
    sizes = _column(mesh.polygons, "loop_total")
    position = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", position)
    flat = position.reshape(-1, 3) @ [[0.11, 0.02], [-0.03, 0.13], [0.04, -0.05]]
    flat += rng.uniform(-0.02, 0.02, flat.shape)
    island = np.repeat(rng.integers(0, 3, len(sizes)), sizes)
    shared = rng.random(len(mesh.vertices)) < 0.4
    island[shared[corner_vertex]] = 0
    uv = flat[corner_vertex] + np.array([(0, 0), (0.03, 0.4), (0.5, -0.02)])[island]
    mesh.uv_layers.new(name="UV").data.foreach_set("uv", uv.astype(np.float32).ravel())


def crease(mesh: bpy.types.Mesh, kind: str, seed: int = 0) -> None:
    CREASES[kind](mesh, np.random.default_rng(seed))


def _fractional_edges(mesh: bpy.types.Mesh, rng: np.random.Generator) -> None:
    """Some edges, each with a sharpness of its own, up to 6."""
    _set(mesh.edge_creases_ensure(), rng.uniform(0.1, 0.77, len(mesh.edges)), rng, 0.4)


def _sharp_loops(mesh: bpy.types.Mesh, rng: np.random.Generator) -> None:
    """Infinitely sharp edges around every third face: no crease ends anywhere."""
    sizes = _column(mesh.polygons, "loop_total")
    in_third_face = np.repeat(np.arange(len(sizes)) % 3 == 0, sizes)
    values = np.zeros(len(mesh.edges), np.float32)
    values[_column(mesh.loops, "edge_index")[in_third_face]] = 1
    mesh.edge_creases_ensure().data.foreach_set("value", values)


def _sharp_edges(mesh: bpy.types.Mesh, rng: np.random.Generator) -> None:
    """Some infinitely sharp edges, chosen at random, so that some end inside the mesh."""
    _set(mesh.edge_creases_ensure(), np.ones(len(mesh.edges)), rng, 0.25)


def _vertices(mesh: bpy.types.Mesh, rng: np.random.Generator) -> None:
    """Some vertices, one in four of them infinitely sharp."""
    count = len(mesh.vertices)
    values = np.where(rng.random(count) < 0.25, 1.0, rng.uniform(0.1, 0.77, count))
    _set(mesh.vertex_creases_ensure(), values, rng, 0.5)


def _both(mesh: bpy.types.Mesh, rng: np.random.Generator) -> None:
    _fractional_edges(mesh, rng)
    _vertices(mesh, rng)


def _loose_edges(mesh: bpy.types.Mesh, rng: np.random.Generator) -> None:
    """Edges that belong to no face, from every fourth vertex upwards."""
    count, edges = len(mesh.vertices), len(mesh.edges)
    held = np.arange(0, count, 4, dtype=np.int32)
    position = np.empty(3 * count, np.float32)
    mesh.vertices.foreach_get("co", position)
    ends = np.empty(2 * edges, np.int32)
    mesh.edges.foreach_get("vertices", ends)
    loose = np.stack([held, count + np.arange(len(held), dtype=np.int32)], axis=1)
    mesh.vertices.add(len(held))
    mesh.edges.add(len(held))
    in_the_air = position.reshape(-1, 3)[held] + np.float32([0, 0, 1])
    mesh.vertices.foreach_set("co", np.concatenate([position, in_the_air.ravel()]))
    mesh.edges.foreach_set("vertices", np.concatenate([ends, loose.ravel()]))
    mesh.update()


CREASES: dict[str, Callable[[bpy.types.Mesh, np.random.Generator], None]] = {
    "none": lambda mesh, rng: None,
    "fractional edges": _fractional_edges,
    "sharp loops": _sharp_loops,
    "sharp edges": _sharp_edges,
    "vertices": _vertices,
    "edges and vertices": _both,
    "loose edges": _loose_edges,
}


def _set(
    attribute: bpy.types.Attribute, values: np.ndarray, rng: np.random.Generator, part: float
) -> None:
    values = np.where(rng.random(len(values)) < part, values, 0)
    attribute.data.foreach_set("value", values.astype(np.float32))


def _column(collection: bpy.types.bpy_prop_collection, key: str) -> np.ndarray:
    values = np.empty(len(collection), np.int32)
    collection.foreach_get(key, values)
    return values
