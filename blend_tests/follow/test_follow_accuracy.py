# SPDX-License-Identifier: GPL-3.0-or-later
"""How exact roots are that follow: creases, rules, polygons, poles, extraordinary vertices, meshes
far from the origin. limitsurf is asked on the control mesh of the frame.
"""

from collections.abc import Sequence

import bpy
import follow_truth
import limitsurf
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes

FRAMES = ((1, 0.0), (17, 0.25), (30, 0.0))
DEPTHS = range(1, 23)


def cage_positions(ob: bpy.types.Object) -> np.ndarray:
    return scenes.surface_without_addon(ob).positions


def errors(
    ob: bpy.types.Object,
    points: bpy.types.Object,
    surface: limitsurf.LimitSurface | None = None,
    rows: slice | np.ndarray = slice(None),
) -> tuple[float, float]:
    """Returns the largest errors over the frames: of positions as a share of the diagonal, and of
    the columns of frames. The surface has the topology and rules, if they are not the default.
    """
    worst = np.zeros(2)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        if surface is not None:
            surface.set_positions(cage_positions(ob))
        now = follow_truth.on_surface(ob, points.data, surface=surface)
        position = follow_truth.shown(points, ids.POSITION) - now.position
        away = np.abs(position[rows]).max() / follow_truth.diagonal(ob)
        turned = [
            np.abs(follow_truth.shown(points, name) - now.frame[:, :, column])[rows].max()
            for name, column in ((ids.TANGENT, 0), (ids.NORMAL, 2))
        ]
        worst = np.maximum(worst, [away, max(turned)])
    return float(worst[0]), float(worst[1])


def bind(ob: bpy.types.Object, points: bpy.types.Object) -> None:
    scenes.activate(points)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}


def check(ob: bpy.types.Object, surface: limitsurf.LimitSurface | None = None) -> None:
    points = scenes.add_points(ob, per_side=3, follow="NODES")
    position, frame = errors(ob, points, surface)
    assert position < follow_truth.POSITION_BOUND
    assert frame < follow_truth.FRAME_BOUND


def faces_of(ob: bpy.types.Object) -> list[list[int]]:
    return [list(polygon.vertices) for polygon in ob.data.polygons]


def test_creases_and_sharp_vertices():
    ob = scenes.grid_with_holes()
    follow_truth.animate(ob)
    scenes.add_subsurf(ob)
    rng = np.random.default_rng(7)
    creases = np.where(rng.random(len(ob.data.edges)) < 0.4, rng.random(len(ob.data.edges)), 0)
    creases[::7] = 1
    creases = creases.astype(np.float32)
    attributes.write(ob.data, ids.EDGE_CREASE, "FLOAT", "EDGE", creases)
    corners = np.zeros(len(ob.data.vertices), np.float32)
    corners[[8, 15]] = [0.3, 1]
    attributes.write(ob.data, ids.VERTEX_CREASE, "FLOAT", "POINT", corners)
    ends = attributes.read(ob.data, ids.EDGE_VERTICES)
    # what Blender adds to vertices of two edges
    degree = np.bincount(ends.ravel())
    edge_sharpness = 10 * creases.astype(np.float64) ** 2
    vertex_sharpness = 10 * corners.astype(np.float64) ** 2
    for vertex in np.flatnonzero(degree == 2):
        least = edge_sharpness[(ends == vertex).any(axis=1)].min()
        vertex_sharpness[vertex] = min(10, vertex_sharpness[vertex] + least)
    mesh = limitsurf.ControlMesh.from_faces(
        cage_positions(ob),
        faces_of(ob),
        edge_sharpness=(ends, edge_sharpness),
        vertex_sharpness=(np.arange(len(corners)), vertex_sharpness),
    )
    check(ob, limitsurf.LimitSurface(mesh))


@pytest.mark.parametrize("scene", scenes.SCENES)
def test_pinned_corners(scene):
    ob = scenes.SCENES[scene]()
    follow_truth.animate(ob)
    scenes.add_subsurf(ob, "PRESERVE_CORNERS")
    check(ob)


@pytest.mark.parametrize("scene", ["grid with holes", "mixed polygons"])
def test_simple_subdivision(scene):
    ob = scenes.SCENES[scene]()
    follow_truth.animate(ob)
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    mesh = limitsurf.ControlMesh.from_faces(cage_positions(ob), faces_of(ob), scheme="bilinear")
    check(ob, limitsurf.LimitSurface(mesh))


@pytest.mark.parametrize("valence", [3, 7, *scenes.slow(100)])
def test_a_pole(valence):
    """Triangles around a vertex, and quads around them."""
    angle = 2 * np.pi * np.arange(valence) / valence
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    positions = np.concatenate([[[0, 0, 0.7]], ring, 2 * ring - [0, 0, 0.4]])
    following = (np.arange(valence) + 1) % valence
    faces: list[Sequence[int]] = [(0, 1 + i, 1 + j) for i, j in enumerate(following)]
    faces += [(1 + i, 1 + valence + i, 1 + valence + j, 1 + j) for i, j in enumerate(following)]
    ob = scenes.add_mesh("Pole", positions, faces)
    follow_truth.animate(ob)
    scenes.add_subsurf(ob)
    check(ob)


@pytest.mark.parametrize("distance", [100.0, 1e4])
def test_far_from_the_origin(distance):
    """In single precision the control mesh itself is rounded to a share of its distance."""
    ob = scenes.grid_with_holes()
    ob.data.transform(((1, 0, 0, distance), (0, 1, 0, -distance), (0, 0, 1, 0), (0, 0, 0, 1)))
    wave = ob.modifiers.new("Wave", "WAVE")
    wave.start_position_x, wave.start_position_y = distance, -distance
    scenes.add_subsurf(ob)
    points = scenes.add_points(ob, per_side=3, follow="NODES")
    position, frame = errors(ob, points)
    rounding = 2**-24 * distance / follow_truth.diagonal(ob)
    assert position < follow_truth.POSITION_BOUND + 8 * rounding
    # derivatives are differences of control points, which keep their absolute error
    assert frame < follow_truth.FRAME_BOUND + 64 * rounding


CORNERS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float64)


def near_corners(surface: limitsurf.LimitSurface) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns faces, uvs and distances of places that approach each corner of each face, and of the
    corners themselves.
    """
    distances = np.array([*(2.0**-depth for depth in DEPTHS), 0.0])
    inwards = 1 - 2 * CORNERS
    slanted = inwards * [0.9, 0.6]
    uv = CORNERS[:, None] + distances[:, None] * slanted[:, None]
    count = surface.face_count
    face = np.repeat(np.arange(count), 4 * len(distances))
    return face, np.tile(uv.reshape(-1, 2), (count, 1)), np.tile(distances, 4 * count)


def put(points: bpy.types.Object, surface: limitsurf.LimitSurface) -> np.ndarray:
    """Gives the points places near corners, and returns their distances from these."""
    face, uv, distance = near_corners(surface)
    # a place near the corner (1, 1) cannot be closer than single precision tells from 1
    uv = uv.astype(np.float32)
    mesh = points.data
    mesh.vertices.add(len(face) - len(mesh.vertices))
    at = surface.evaluate(face, uv.astype(np.float64), derivatives=1)
    frame = surface.frames(face, uv.astype(np.float64))
    attributes.write(mesh, ids.POSITION, "FLOAT_VECTOR", "POINT", at.position)
    attributes.write(mesh, ids.FACE, "INT", "POINT", face)
    attributes.write(mesh, ids.UV, "FLOAT2", "POINT", uv)
    attributes.write(mesh, ids.REST_ROOT, "FLOAT_VECTOR", "POINT", at.position)
    rotation = follow_truth.quaternions(frame)
    for name in (ids.REST_ROTATION, ids.ROTATION):
        attributes.write(mesh, name, "QUATERNION", "POINT", rotation)
    for name, column in ((ids.TANGENT, 0), (ids.NORMAL, 2)):
        attributes.write(mesh, name, "FLOAT_VECTOR", "POINT", frame[:, :, column])
    return distance


def one_face_corners(ob: bpy.types.Object, points: bpy.types.Object) -> np.ndarray:
    """Tells which places are next to a vertex with one face, a quad."""
    face, uv = scenes.locations(points.data)
    surface = scenes.surface_without_addon(ob)
    corner_vertex = attributes.read(ob.data, ids.CORNER_VERTEX)
    faces_at = np.bincount(corner_vertex)
    first = np.array([polygon.loop_start for polygon in ob.data.polygons])
    is_quad = np.array([polygon.loop_total == 4 for polygon in ob.data.polygons])
    base = surface.base_face[face]
    nearest = np.abs(uv[:, None] - CORNERS).max(axis=2).argmin(axis=1)
    vertex = corner_vertex[first[base] + np.where(is_quad[base], nearest, surface.corner[face])]
    return (faces_at[vertex] == 1) & (is_quad[base] | (nearest == 0))


@pytest.mark.parametrize("scene", scenes.SMALL_FIRST)
def test_roots_near_extraordinary_vertices(scene):
    ob = scenes.SCENES[scene]()
    follow_truth.animate(ob)
    scenes.add_subsurf(ob)
    points = scenes.add_points(ob, per_side=1, follow="NONE")
    distance = put(points, scenes.surface_without_addon(ob))
    bind(ob, points)
    is_corner = one_face_corners(ob, points)
    at_vertex = distance == 0
    in_corner = is_corner & (distance < 2**-12)
    position, frame = errors(ob, points, rows=~at_vertex & ~in_corner)
    assert position < follow_truth.POSITION_BOUND
    assert frame < follow_truth.FRAME_BOUND
    # du and dv become antiparallel at the corner, and the frame is lost with them
    if in_corner.any():
        position, frame = errors(ob, points, rows=in_corner & (distance > 2**-15))
        assert position < follow_truth.POSITION_BOUND
        assert frame < 2e-4
        position, frame = errors(ob, points, rows=in_corner & ~at_vertex)
        assert position < follow_truth.POSITION_BOUND
        assert frame < 5e-2
    position, frame = errors(ob, points, rows=at_vertex)
    assert position < follow_truth.POSITION_BOUND
    # the place 2^-24 from the vertex stands for it: along boundaries of three and more faces the
    # tangent converges only like 0.86^depth, and at two faces no normal exists
    assert frame < 0.2
