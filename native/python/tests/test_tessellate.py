# SPDX-License-Identifier: Apache-2.0
"""Polygons on the limit surface with levels that differ from face to face.

What is looked at is the mesh alone: which points its polygons share, and where their corners are.
"""

from collections import Counter
from functools import partial

import limitsurf as ls
import numpy as np
import pytest
import shapes

STEPS = 4096  # corners lie at multiples of 1 / STEPS


def three_sheets():
    """Three grids that share an edge, one of them with a face of five corners."""
    positions, faces = shapes.grid(2, 2)
    sheets, count = [], len(positions)
    moved = []
    for turn in (0.3, 2.2, 4.4):
        p = positions.copy()
        p[:, 0], p[:, 2] = positions[:, 0] * np.cos(turn), positions[:, 0] * np.sin(turn)
        moved.append(p)
        sheets += (faces + count * len(moved) - count).tolist()
    points = np.concatenate(moved)
    same = np.arange(len(points))
    for row in range(3):  # x = 0 is the same line in all of them
        same[[row * 3 + count, row * 3 + 2 * count]] = row * 3
    used, names = np.unique(same, return_inverse=True)
    sheets = [[int(names[v]) for v in face] for face in sheets]
    points = np.concatenate([points[used], [[1.5, 2.5, 0.2]]])
    sheets[3] = [*sheets[3][:3], len(points) - 1, sheets[3][3]]
    return points, sheets


def creased_house():
    positions, faces = shapes.house()
    sharpness = ([[0, 1], [4, 5], [5, 9], [9, 8], [6, 7]], [3, 10, 10, 2.5, 10])
    return ls.ControlMesh.from_faces(positions, faces, edge_sharpness=sharpness)


def with_holes():
    rng = np.random.default_rng(4)
    positions, faces = shapes.grid(5, 4)
    positions += rng.uniform(-0.2, 0.2, positions.shape)
    triangles = [[0, 1, 7], [0, 7, 6]]  # instead of the first quad
    return ls.ControlMesh.from_faces(positions, [*triangles, *faces[1:].tolist()], holes=[8, 13])


def bilinear():
    positions, faces = shapes.house()
    return ls.ControlMesh.from_faces(positions, faces, scheme="bilinear")


MESHES = {
    **{name: partial(ls.ControlMesh.from_faces, *shape) for name, shape in shapes.ALL.items()},
    "pole": partial(ls.ControlMesh.from_faces, *shapes.pole(7)),
    "three sheets": partial(ls.ControlMesh.from_faces, *three_sheets()),
    "creased house": creased_house,
    "holes": with_holes,
    "bilinear": bilinear,
}


def random_levels(mesh, rng, most=4):
    return np.maximum(rng.integers(0, most + 1, len(mesh.face_sizes)), mesh.face_sizes != 4)


@pytest.fixture(params=MESHES, scope="module")
def divided(request):
    """A surface and tessellations of it, with their levels."""
    mesh = MESHES[request.param]()
    surface = ls.LimitSurface(mesh)
    rng = np.random.default_rng(len(request.param))
    levels = [random_levels(mesh, rng) for _ in range(3)]
    steep = np.maximum(mesh.face_sizes != 4, 0)  # one face alone is fine
    steep[-1] = 5
    return surface, [(each, surface.tessellate(each)) for each in [*levels, steep]]


def corner_steps(t):
    steps = t.corner_uv * STEPS
    assert (steps == steps.round()).all()
    return steps.astype(int)


def following(t):
    """The next corner around each corner's polygon."""
    bounds = shapes.row_bounds(t.face_sizes)
    after = np.arange(len(t.face_vertices)) + 1
    after[bounds[1:] - 1] = bounds[:-1]
    return after


def cage_sides(mesh):
    """(from, to, face) around every face that has a surface."""
    faces = np.split(mesh.face_vertices, np.cumsum(mesh.face_sizes)[:-1])
    for number, face in enumerate(faces):
        if number not in mesh.holes:
            yield from ((a, b, number) for a, b in zip(face, np.roll(face, -1), strict=True))


def edge_levels(mesh, levels):
    """Of each edge, as a sorted pair of vertices: the largest of its faces."""
    largest = {}
    for a, b, face in cage_sides(mesh):
        edge = (min(a, b), max(a, b))
        largest[edge] = max(largest.get(edge, 0), int(levels[face]))
    return largest


def test_polygons_meet_along_whole_sides(divided):
    """As many polygons at a segment of a cage's edge as the edge has faces, and two inside."""
    surface, tessellations = divided
    faces_at = Counter((min(a, b), max(a, b)) for a, b, _ in cage_sides(surface.mesh))
    for levels, t in tessellations:
        largest = edge_levels(surface.mesh, levels)
        side = np.stack([t.face_vertices, t.face_vertices[following(t)]], axis=1)
        assert (side[:, 0] != side[:, 1]).all()
        _, counts = np.unique(np.sort(side, axis=1), axis=0, return_counts=True)
        for many in {*counts, *faces_at.values()} - {2}:
            edges = [edge for edge, faces in faces_at.items() if faces == many]
            assert (counts == many).sum() == sum(2 ** largest[edge] for edge in edges)


def test_sides_run_as_the_cage_does(divided):
    """No polygon is turned: a side is used twice in one direction only where the cage's edge is."""
    surface, tessellations = divided
    counted = Counter((a, b) for a, b, _ in cage_sides(surface.mesh))
    for levels, t in tessellations:
        largest = edge_levels(surface.mesh, levels)
        side = np.stack([t.face_vertices, t.face_vertices[following(t)]], axis=1)
        _, counts = np.unique(side, axis=0, return_counts=True)
        for many in {*counts, *counted.values()} - {1}:
            edges = [tuple(sorted(edge)) for edge, count in counted.items() if count == many]
            assert (counts == many).sum() == sum(2 ** largest[edge] for edge in edges)


def test_edges_have_the_larger_level(divided):
    """Points in a chain between the cage's vertices: all multiples of 2^-level along an edge."""
    surface, tessellations = divided
    mesh = surface.mesh
    for levels, t in tessellations:
        largest = edge_levels(mesh, levels)
        steps, face_of = corner_steps(t), np.repeat(t.base_face, t.face_sizes)
        for face in range(len(levels)):
            if face in mesh.holes or mesh.face_sizes[face] != 4:
                continue
            here = steps[face_of == face]
            corners = mesh.face_vertices[mesh.face_sizes[:face].sum() :][:4]
            for k, (axis, at) in enumerate(((1, 0), (0, STEPS), (1, STEPS), (0, 0))):
                a, b = sorted((corners[k], corners[(k + 1) % 4]))
                along = np.unique(here[here[:, axis] == at][:, 1 - axis])
                expected = np.linspace(0, STEPS, 2 ** largest[a, b] + 1)
                np.testing.assert_array_equal(along, expected)


def test_polygons_cover_each_ptex_face_once(divided):
    """Counter-clockwise, of positive area, which add up exactly; and no two overlap."""
    surface, tessellations = divided
    for _, t in tessellations:
        steps, after = corner_steps(t), following(t)
        nothing = np.zeros(len(t.face_sizes), int)
        polygon = np.repeat(np.arange(len(t.face_sizes)), t.face_sizes)
        twice = nothing.copy()
        np.add.at(twice, polygon, steps[:, 0] * steps[after, 1] - steps[after, 0] * steps[:, 1])
        assert (twice > 0).all()
        total = np.bincount(t.ptex_face, weights=twice, minlength=surface.face_count)
        covered = ~np.isin(surface.base_face, list(surface.refused))
        np.testing.assert_array_equal(total[covered], 2 * STEPS**2)
        assert not total[~covered].any()
        np.testing.assert_array_equal(surface.base_face[t.ptex_face], t.base_face)


def test_cells_are_as_fine_as_asked(divided):
    """No polygon is larger than a cell of its face's level."""
    surface, tessellations = divided
    for levels, t in tessellations:
        steps = corner_steps(t)
        polygon_ends = np.cumsum(t.face_sizes)[:-1]
        size = np.array([np.ptp(p, axis=0).max() for p in np.split(steps, polygon_ends)])
        is_quad = surface.mesh.face_sizes[t.base_face] == 4
        cell = STEPS // 2 ** np.where(is_quad, levels[t.base_face], levels[t.base_face] - 1)
        assert (size <= cell).all()


@pytest.mark.parametrize("difference", [0, 1, 2])
def test_no_slivers_where_levels_differ_little(difference):
    """No angle in (u, v) below 18 degrees for differences to 2."""
    mesh = ls.ControlMesh.from_faces(*shapes.house())
    rng = np.random.default_rng(difference)
    levels = 2 + rng.integers(0, difference + 1, len(mesh.face_sizes))
    t = ls.LimitSurface(mesh).tessellate(levels)
    steps = corner_steps(t).astype(float)
    after = following(t)
    before = np.empty_like(after)
    before[after] = np.arange(len(after))
    out, back = steps[after] - steps, steps[before] - steps
    cosine = (out * back).sum(axis=1) / np.linalg.norm(out, axis=1) / np.linalg.norm(back, axis=1)
    assert np.degrees(np.arccos(cosine)).min() > (18 if difference == 2 else 44)


def test_points_lie_where_their_locations_say(divided):
    surface, tessellations = divided
    for _, t in tessellations:
        here = surface.evaluate(t.locations.face, t.locations.uv, 1)
        np.testing.assert_array_equal(t.positions, here.position)
        known = ~np.isnan(here.normal[:, 0])
        np.testing.assert_array_equal(t.normals[known], here.normal[known])
        frames = surface.frames(t.locations.face[~known], t.locations.uv[~known])
        np.testing.assert_array_equal(t.normals[~known], frames[:, :, 2])
        assert len(np.unique(t.face_vertices)) == len(t.positions)


def test_corners_lie_where_their_points_do(divided):
    surface, tessellations = divided
    for _, t in tessellations:
        at = t.corner_locations
        corner = surface.evaluate(at.face, at.uv).position
        np.testing.assert_allclose(corner, t.positions[t.face_vertices], atol=1e-12)


def test_faces_are_the_same_with_and_without_ends(divided):
    _, tessellations = divided
    for _, t in tessellations:
        assert set(t.face_sizes) <= {3, 4}
        np.testing.assert_array_equal((t.faces >= 0).sum(axis=1), t.face_sizes)
        np.testing.assert_array_equal(t.faces[t.faces >= 0], t.face_vertices)
        assert ((t.faces[:, 3] < 0) == (t.face_sizes == 3)).all()


@pytest.mark.parametrize("name", ["cube", "house", "three sheets"])
def test_equal_levels_are_one_level(name):
    surface = ls.LimitSurface(MESHES[name]())
    one = surface.tessellate(3)
    many = surface.tessellate(np.full(len(surface.mesh.face_sizes), 3, np.int8))
    for field in ("positions", "normals", "faces", "base_face", "ptex_face", "corner_uv"):
        np.testing.assert_array_equal(getattr(one, field), getattr(many, field))
    assert one.corner_normals is None


def test_one_level_makes_points_in_the_order_of_polygons(divided):
    surface, tessellations = divided
    for t in (surface.tessellate(2), tessellations[0][1]):
        _, seen_first = np.unique(t.face_vertices, return_index=True)
        if len(t.face_sizes) and (t.face_sizes == 4).all():
            assert (np.diff(seen_first) > 0).all()


def test_corner_normals_are_seen_from_each_side():
    """A cube with infinitely sharp edges around one face: two normals along them, far apart."""
    positions, faces = shapes.cube()
    lid = faces[1]
    sharp = (np.stack([lid, np.roll(lid, -1)], axis=1), np.full(4, 10))
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, edge_sharpness=sharp))
    t = surface.tessellate([3, 2, 4, 2, 3, 2], corner_normals=True)
    at = t.corner_locations
    # What is seen a little way inside the corner's own polygon.
    starts = shapes.row_bounds(t.face_sizes)[:-1]
    middle = np.add.reduceat(at.uv, starts) / t.face_sizes[:, None]
    towards = np.repeat(middle, t.face_sizes, axis=0) - at.uv
    near = surface.evaluate(at.face, at.uv + 1e-7 * towards, 1).normal
    assert np.abs(t.corner_normals - near).max() < 1e-4
    spread = np.linalg.norm(t.corner_normals - t.normals[t.face_vertices], axis=1)
    base = np.repeat(t.base_face, t.face_sizes)
    lid_points = np.unique(t.face_vertices[base == 1])
    on_crease = np.isin(t.face_vertices, lid_points) & (base != 1)
    assert on_crease.sum() > 4 * 8
    assert spread[on_crease].min() > 0.5
    assert spread[~on_crease].max() < 1e-11


def test_threads_do_not_matter(divided):
    surface, tessellations = divided
    levels, t = tessellations[0]
    again = surface.tessellate(levels, threads=1, corner_normals=True)
    for field in ("positions", "normals", "faces", "corner_uv"):
        np.testing.assert_array_equal(getattr(again, field), getattr(t, field))


def test_progress_is_told_and_may_end_the_call():
    surface = ls.LimitSurface(MESHES["cube"]())
    told = []
    surface.tessellate([7] * 6, corner_normals=True, progress=told.append)
    assert told == sorted(told)
    assert 0 < told[0] < 1 == told[-1]

    def stop(part):
        raise KeyError(part)

    with pytest.raises(KeyError):
        surface.tessellate(3, progress=stop)
    with pytest.raises(TypeError, match="callable"):
        surface.tessellate(3, progress=3)


@pytest.mark.parametrize(
    ("levels", "error", "match"),
    [
        ([1, 1, 1], ValueError, "levels has 3 values for 8 faces"),
        ([1, 1, 0, 1, 1, 1, 1, 1], ValueError, "face 2, of 5 corners, has level 0; expected 1"),
        ([1, 1, 1, 1, -1, 1, 1, 1], ValueError, "face 4, of 4 corners, has level -1; expected 0"),
        ([1, 1, 1, 1, 1, 1, 1, 13], ValueError, "face 7, of 4 corners, has level 13"),
        ([1, 1, 1, 1, 1, 1, 1, 2**40], ValueError, r"levels\[7\] is 1099511627776; exp"),
        ([1.0] * 8, TypeError, "levels"),
        ([[1] * 8], ValueError, r"levels has shape \(1, 8\)"),
        (None, TypeError, "levels"),
        (13, ValueError, "levels is 13; expected 1 to 12"),
        (0, ValueError, "levels is 0; expected 1 to 12"),
        (2**63, ValueError, "levels is 9223372036854775808; expected 1 to 12"),
        (-(2**70), ValueError, "levels is -1180591620717411303424; expected 1 to 12"),
    ],
)
def test_levels_that_are_refused(levels, error, match):
    surface = ls.LimitSurface(MESHES["house"]())
    with pytest.raises(error, match=match):
        surface.tessellate(levels)


@pytest.mark.parametrize("view", [{"matrix": np.full((4, 4), np.nan)}, {"nearest": np.nan}])
def test_views_that_are_refused(view):
    surface = ls.LimitSurface(MESHES["house"]())
    with pytest.raises(ValueError, match="finite"):
        surface.levels_of_length(0.5, **{"matrix": np.eye(4), **view})


def test_levels_of_refused_faces_mean_nothing():
    surface = ls.LimitSurface(with_holes())
    levels = np.full(len(surface.mesh.face_sizes), 2)
    expected = surface.tessellate(levels)
    levels[[8, 13]] = [-7, 99]
    np.testing.assert_array_equal(surface.tessellate(levels).faces, expected.faces)


def test_too_many_points_are_refused_before_they_are_made():
    positions, faces = shapes.grid(20, 10)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    with pytest.raises(ValueError, match="points or more are too many"):
        surface.tessellate([12] * 200)
