# SPDX-License-Identifier: Apache-2.0
"""Limit curves of edges and locations along them."""

import ctrl_c
import limitsurf as ls
import numpy as np
import pytest
import shapes

NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def spline_speed(p, t):
    """Of a uniform cubic B-spline with the control points p (4, 3), at t (n,)."""
    weights = np.stack(
        [-((1 - t) ** 2) / 2, (3 * t**2 - 4 * t) / 2, (-3 * t**2 + 2 * t + 1) / 2, t**2 / 2]
    )
    return np.linalg.norm(weights.T @ p, axis=1)


def spline_length(p, vertices):
    """The length of the closed spline of these vertices."""
    total = 0.0
    for i in range(len(vertices)):
        at = p[np.take(vertices, np.arange(i - 1, i + 3), mode="wrap")]
        for part in range(8):
            total += spline_speed(at, (part + (NODES + 1) / 2) / 8) @ WEIGHTS / 16
    return total


def curve_vertices(curves, i):
    return curves.edges[curves.offsets[i] : curves.offsets[i + 1], 0]


@pytest.mark.parametrize("name", ["grid", "house", "interior fan", "boundary fan", "corner"])
def test_boundaries_are_as_long_as_their_splines(name):
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.ALL[name]))
    curves = surface.edge_curves("boundary")
    assert len(curves) == 1
    assert curves.closed.all()
    (length,) = curves.lengths
    assert length == pytest.approx(
        spline_length(surface.positions, curve_vertices(curves, 0)), rel=1e-9
    )
    assert curves.edge_lengths.sum() == pytest.approx(length, rel=1e-12)


def test_what_a_chain_tells():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(4, 3)))
    curves = surface.edge_curves()
    assert isinstance(curves, ls.EdgeCurves)
    assert curves.offsets.tolist() == [0, 14]
    assert curves.edges.shape == (14, 2)
    assert curves.edges.dtype == np.int32
    np.testing.assert_array_equal(curves.edges[1:, 0], curves.edges[:-1, 1])
    assert curves.edges[0].tolist() == [0, 1]
    assert curves.faces[0].tolist() == [0, -1]
    assert curves.closed.dtype == bool
    assert curves.left_out == 0


def test_creases_are_edges_of_two_faces():
    positions, faces = shapes.cube()
    mesh = ls.ControlMesh.from_faces(
        positions, faces, edge_sharpness=([[0, 1], [1, 3], [3, 2]], [10, 0.5, 0])
    )
    curves = ls.LimitSurface(mesh).edge_curves("creases")
    assert {frozenset(edge) for edge in curves.edges.tolist()} == {
        frozenset((0, 1)),
        frozenset((1, 3)),
    }
    assert (curves.faces >= 0).all()


def test_locations_along_curves():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.house()))
    curves = surface.edge_curves()
    along = surface.scatter_along(curves, count=50, seed=3)
    assert isinstance(along, ls.AlongCurves)
    assert isinstance(along, ls.Locations)
    assert len(along) == 50
    assert along.face.dtype == np.int32
    assert along.uv.shape == (50, 2)
    np.testing.assert_allclose(np.diff(along.arc), curves.lengths[0] / 50, rtol=1e-9)
    normal = surface.frames(along.face, along.uv)[:, :, 2]
    for vectors in (along.tangent, along.outward):
        np.testing.assert_allclose(np.linalg.norm(vectors, axis=1), 1)
        np.testing.assert_allclose(np.sum(vectors * normal, axis=1), 0, atol=1e-12)
    again = curves.at(along.curve, along.arc)
    np.testing.assert_array_equal(again.face, along.face)
    np.testing.assert_array_equal(again.uv, along.uv)


def test_positions_between_neighbours_have_that_length():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.fan(5, False)))
    curves = surface.edge_curves()
    arc = np.linspace(0, curves.lengths[0], 100_001)
    at = curves.at(0, arc)
    steps = np.linalg.norm(np.diff(surface.evaluate(at.face, at.uv).position, axis=0), axis=1)
    np.testing.assert_allclose(steps, arc[1], rtol=1e-5)


def test_phase_and_spacing():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(4, 3)))
    curves = surface.edge_curves()
    length = curves.lengths[0]
    along = surface.scatter_along(curves, spacing=length / 20.3, phase=0.5)
    np.testing.assert_allclose(along.arc, length * (np.arange(20) + 0.5) / 20)
    other = surface.scatter_along(curves, None, length / 20.3, 0, 5)
    assert not np.allclose(other.arc, along.arc)


def test_both_sides_of_an_edge():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.cube()))
    curves = surface.edge_curves([[0, 1], [1, 3]])
    left, right = (surface.scatter_along(curves, 8, side=side) for side in ("left", "right"))
    np.testing.assert_allclose(
        surface.evaluate(left.face, left.uv).position,
        surface.evaluate(right.face, right.uv).position,
        atol=1e-12,
    )
    assert not (left.face == right.face).any()
    np.testing.assert_allclose(left.outward, -right.outward, atol=1e-9)


def test_curves_are_those_of_one_pose():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(4, 3)))
    other = ls.LimitSurface(surface.mesh)
    curves = surface.edge_curves()
    with pytest.raises(ValueError, match="another surface"):
        other.scatter_along(curves, 5)
    surface.set_positions(2 * surface.positions)
    with pytest.raises(ValueError, match="posed the surface since"):
        surface.scatter_along(curves, 5)
    with pytest.raises(ValueError, match="posed the surface since"):
        curves.at(0, [0.0])
    assert surface.edge_curves().lengths[0] == pytest.approx(2 * curves.lengths[0])


def test_curves_keep_their_surface_alive():
    curves = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(4, 3))).edge_curves()
    assert len(curves.at(0, [0.0, 1.0])) == 2


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        ({}, "exactly one of count and spacing"),
        ({"count": 1, "spacing": 1.0}, "exactly one of count and spacing"),
        ({"count": -1}, "count is -1"),
        ({"spacing": 0.0}, "spacing is 0"),
        ({"spacing": 1e-300}, "the limit is"),
        ({"count": 1, "jitter": 1.1}, "jitter is 1.1"),
        ({"count": 1, "phase": -0.5}, "phase is -0.5"),
        ({"count": 1, "side": "above"}, "side is 'above'"),
        ({"count": 1, "threads": -1}, "threads is -1"),
    ],
)
def test_what_has_no_meaning_is_refused(arguments, match):
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(4, 3)))
    with pytest.raises(ValueError, match=match):
        surface.scatter_along(surface.edge_curves(), **arguments)


def test_wrong_edges_are_refused(cube):
    with pytest.raises(ls.MeshError, match="row 1: the mesh has no edge between.* 0 and 3"):
        cube.edge_curves([[0, 1], [0, 3]])
    with pytest.raises(ls.MeshError, match="expected 'boundary' or 'creases'"):
        cube.edge_curves("seams")
    with pytest.raises(ls.MeshError, match=r"expected \(n, 2\)"):
        cube.edge_curves([0, 1, 2])
    with pytest.raises(TypeError):
        cube.edge_curves([[0.0, 1.0]])
    assert len(cube.edge_curves("boundary")) == 0
    assert len(cube.edge_curves([])) == 0


def test_rows_that_are_on_no_curve_are_named(cube):
    curves = cube.edge_curves([[0, 1]])
    with pytest.raises(ValueError, match="row 1: there is no curve 1"):
        curves.at([0, 1], [0.0, 0.0])
    with pytest.raises(ValueError, match="row 0: arc length -0.5"):
        curves.at(0, [-0.5])


def test_ctrl_c_ends_it():
    program = """
import limitsurf as ls, shapes
surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(4, 3)))
curves = surface.edge_curves()
print("ready", flush=True)
surface.scatter_along(curves, 50_000_000)
"""
    assert "KeyboardInterrupt" in ctrl_c.errors_of(program)


def test_progress_and_cancelling():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(4, 3)))
    curves, parts = surface.edge_curves(), []
    surface.scatter_along(curves, 200_000, progress=parts.append)
    assert parts[-1] == 1
    assert parts == sorted(parts)

    def stop(part):
        raise KeyError

    with pytest.raises(KeyError):
        surface.scatter_along(curves, 10, progress=stop)


def chords(points, radius):
    """Every pair of points that are at most so far apart, in both orders, and their distances."""
    cells = np.floor(points / radius).astype(np.int64)
    cells -= cells.min(axis=0) - 1
    size = cells.max(axis=0) + 2
    key = (cells[:, 0] * size[1] + cells[:, 1]) * size[2] + cells[:, 2]
    order = np.argsort(key)
    sorted_keys = key[order]
    pairs = []
    for shift in np.ndindex(3, 3, 3):
        step = ((shift[0] - 1) * size[1] + shift[1] - 1) * size[2] + shift[2] - 1
        first = np.searchsorted(sorted_keys, key + step, "left")
        last = np.searchsorted(sorted_keys, key + step, "right")
        count = last - first
        a = np.repeat(np.arange(len(points)), count)
        within = np.arange(len(a)) - np.repeat(np.cumsum(count) - count, count)
        pairs.append(np.stack([a, order[np.repeat(first, count) + within]]))
    a, b = np.concatenate(pairs, axis=1)
    length = np.linalg.norm(points[a] - points[b], axis=1)
    near = (length <= radius) & (a != b)
    return a[near], b[near], length[near]


def shortest(points, sources, radius):
    """The lengths of the shortest ways over chords, which neither leave the surface by much nor
    have few directions to choose from."""
    a, b, length = chords(points, radius)
    distance = np.full(len(points), np.inf)
    distance[sources] = 0
    while True:
        better = distance.copy()
        np.minimum.at(better, b, distance[a] + length)
        if np.array_equal(better, distance):
            return distance
        distance = better


@pytest.mark.parametrize("name", ["cube", pytest.param("house", marks=pytest.mark.slow)])
def test_rows_on_curved_surfaces_against_shortest_ways(name):
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.ALL[name]))
    edges = [[0, 1], [1, 3], [3, 2], [2, 0]] if name == "cube" else "boundary"
    curves = surface.edge_curves(edges)
    step = curves.lengths.sum() / 25
    rows = surface.scatter_along(curves, 120, rows=4, row_distance=step, seed=1)
    assert (np.bincount(rows.row, minlength=4) + rows.ended == 120).all()
    assert (np.bincount(rows.row, minlength=4) > 20).all()
    at = surface.evaluate(rows.face, rows.uv).position
    arc = np.linspace(0, curves.lengths[0], 2400)
    border = curves.at(0, arc)
    mesh = surface.tessellate(6)
    points = np.concatenate([surface.evaluate(border.face, border.uv).position, mesh.positions, at])
    ways = shortest(points, np.arange(len(arc)), step * 0.45)[-len(at) :]
    wanted = step * rows.row
    # Most of this is the error of the ways: their chords have not quite the right directions. With
    # level 7 the largest difference is 0.25 %.
    np.testing.assert_allclose(ways[rows.row > 0], wanted[rows.row > 0], rtol=0.01)


def test_rows_run_beside_the_curve():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(8, 8)))
    curves = surface.edge_curves()
    rows = surface.scatter_along(curves, 40, rows=3, row_distance=0.5)
    assert rows.row.dtype == np.int32
    assert rows.ended.tolist()[0] == 0
    assert (np.diff(rows.row) >= 0).all()
    start = curves.at(rows.curve, rows.arc)
    foot = surface.evaluate(start.face, start.uv).position
    at = surface.evaluate(rows.face, rows.uv).position
    np.testing.assert_allclose(
        at - foot, -0.5 * rows.row[:, None] * rows.outward, atol=1e-6
    )  # straight in a plane
    np.testing.assert_allclose(
        np.cross(rows.tangent, rows.outward), np.tile([0, 0, -1.0], (len(rows), 1)), atol=1e-9
    )
    with pytest.raises(ValueError, match="row_distance is 0"):
        surface.scatter_along(curves, 40, rows=2)
    with pytest.raises(ValueError, match="rows is 0"):
        surface.scatter_along(curves, 40, rows=0)
