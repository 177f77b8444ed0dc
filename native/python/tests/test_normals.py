# SPDX-License-Identifier: Apache-2.0
"""A normal is right to its stated bound, or NaN: on folds, slivers and collapsed faces, where
du x dv is small or nothing but rounding.
"""

import limitsurf as ls
import numpy as np
import pytest
import shapes

NORMAL_ERROR = 1e-11  # kNormalError: times the condition number
MOST_CONDITION = 2.0**30  # kMostNormalCondition

# Distances from a fold or a corner, down to far below rounding.
DISTANCES = np.concatenate([[0.0], 2.0 ** -np.arange(1, 61)])
TURN = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]


def places(face, near, along=0.37):
    """At these distances from the sides v = 0 and u = 0. Next to the corner itself, of two faces,
    the surface turns over again and again.
    """
    beside = np.stack([np.full_like(near, along), near], axis=1)
    uv = np.concatenate([beside, beside[:, ::-1]])
    return np.full(len(uv), face), uv


def errors(normal, truth):
    """Radians; rows without a normal are left out."""
    found = normal[np.isfinite(normal[:, 0])]
    assert len(found)
    return np.arctan2(np.linalg.norm(np.cross(found, truth), axis=1), found @ truth)


@pytest.mark.parametrize("spread", [0.0, 0.3])
def test_the_two_sides_of_a_folded_quad(spread):
    # A pillow without thickness: du x dv vanishes along all four edges.
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    square[:, :2] += spread * np.random.default_rng(1).uniform(-1, 1, (4, 2))
    whole = ls.LimitSurface(
        ls.ControlMesh.from_faces(square @ TURN.T, [[0, 1, 2, 3], [3, 2, 1, 0]])
    )
    for face, side in ((0, TURN[:, 2]), (1, -TURN[:, 2])):
        side = side * np.linalg.det(TURN)
        at = places(face, DISTANCES)
        normal = whole.evaluate(*at, 1).normal
        assert errors(normal, side).max() < NORMAL_ERROR * MOST_CONDITION
        inside = whole.evaluate(*places(face, DISTANCES[1:16]), 1).normal
        assert np.isfinite(inside).all()
        assert errors(inside, side).max() < NORMAL_ERROR * 2.0**20
        on_fold = whole.evaluate(np.full(9, face), [[t, 0] for t in np.linspace(0, 1, 9)], 1)
        assert np.isnan(on_fold.normal).all()
        frames = whole.frames(*at).reshape(-1, 3, 3)
        assert np.abs(np.swapaxes(frames, 1, 2) @ frames - np.eye(3)).max() < 1e-14


@pytest.mark.parametrize("exponent", range(0, 61, 4))
def test_slivers(exponent):
    # A plane grid, shrunk in one direction.
    positions, faces = shapes.grid(4, 4)
    thin = positions * [1, 2.0**-exponent, 1]
    whole = ls.LimitSurface(ls.ControlMesh.from_faces(thin @ TURN.T, faces))
    rng = np.random.default_rng(2)
    face, uv = rng.integers(0, len(faces), 200), rng.random((200, 2))
    normal = whole.evaluate(face, uv, 1).normal
    truth = TURN[:, 2] * np.linalg.det(TURN)
    if exponent <= 26:  # a condition of 2^26, times that of the patch at most
        assert np.isfinite(normal).all()
        assert errors(normal, truth).max() < NORMAL_ERROR * 8 * 2.0**exponent
    if exponent >= 32:
        assert np.isnan(normal).all()


@pytest.mark.parametrize("collapsed", ["point", "line"])
def test_a_mesh_without_area_has_no_normals(collapsed):
    positions, faces = shapes.cube()
    axes = np.zeros((3, 3)) if collapsed == "point" else np.outer([1.0, 0.3, 0.11], TURN[0])
    whole = ls.LimitSurface(ls.ControlMesh.from_faces(positions @ axes + TURN[1], faces))
    rng = np.random.default_rng(2)
    at = rng.integers(0, len(faces), 100), rng.random((100, 2))
    assert np.isnan(whole.evaluate(*at, 1).normal).all()
    assert np.isnan(whole.curvature(*at).mean).all()
    assert np.isfinite(whole.frames(*at)).all()


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize(
    "shape",
    [
        shapes.grid(2, 2),
        (shapes.grid(3, 3)[0], shapes.halves(shapes.grid_faces(3, 3))),
        shapes.pole(5),
    ],
)
def test_a_mesh_on_a_line_has_no_normals_where_a_ring_is_one_point(shape, seed):
    # What is around an irregular vertex is in one place: only points farther away have an extent.
    positions, faces = shape
    rng = np.random.default_rng(seed)
    on_line = np.outer(rng.integers(0, 2, len(positions)), [0.3, 0.7, 0.11])
    whole = ls.LimitSurface(ls.ControlMesh.from_faces(on_line, faces))
    face = np.repeat(np.arange(whole.face_count), 100)
    uv = rng.random((len(face), 2))
    uv[::2] = np.abs((uv[::2] > 0.5) - 2.0 ** -rng.integers(1, 41, (len(uv[::2]), 2)))
    assert np.isnan(whole.evaluate(face, uv, 1).normal).all()
    assert np.isnan(whole.curvature(face, uv).mean).all()


def test_an_edge_collapsed_to_a_point():
    # The face's side v = 0 is one point in the control mesh, but the surface there is smooth.
    positions, faces = shapes.grid(3, 3)
    positions[5] = positions[6]
    whole = ls.LimitSurface(ls.ControlMesh.from_faces(positions @ TURN.T, faces))
    rng = np.random.default_rng(2)
    at = rng.integers(0, len(faces), 500), rng.random((500, 2))
    e = whole.evaluate(*at, 1)
    up = TURN[:, 2] * np.linalg.det(TURN)
    truth = np.sign(np.cross(e.du, e.dv) @ up)[:, None] * up
    shown = np.isfinite(e.normal[:, 0])
    assert shown.sum() > 450
    np.testing.assert_allclose(e.normal[shown], truth[shown], atol=NORMAL_ERROR)


def test_towards_a_smooth_corner_of_one_face():
    # du and dv become antiparallel there. Their cross product vanishes, but its direction has a
    # limit, which is approached slowly: as 1 over the number of halvings.
    positions, faces = shapes.fan(1, False)
    whole = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    halvings = np.arange(1, 1000)
    near = np.stack([2.0**-halvings, 2.0 ** -(halvings + 1)], axis=1)
    normal = whole.evaluate(np.zeros(len(near), int), near, 1).normal
    at_corner = whole.evaluate([0], [[0, 0]], 1).normal
    assert (np.linalg.norm(normal - at_corner, axis=1) < 0.2 / halvings).all()
