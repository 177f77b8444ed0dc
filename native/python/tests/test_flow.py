# SPDX-License-Identifier: Apache-2.0
"""Directions of curves, continued over surfaces: arrays, errors, and a field that is known."""

import limitsurf as ls
import numpy as np
import pytest

SIDE = 4


@pytest.fixture
def surface():
    """A flat square, whose limit surface is the square itself."""
    y, x = np.mgrid[: SIDE + 1, : SIDE + 1].reshape(2, -1)
    positions = np.stack([x, y, 0 * x], axis=1)
    first = (np.arange(SIDE)[:, None] * (SIDE + 1) + np.arange(SIDE)).ravel()
    faces = np.stack([first, first + 1, first + SIDE + 2, first + SIDE + 1], axis=1)
    return ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, boundary="corners"))


@pytest.fixture
def at(surface):
    return surface.scatter_jittered(5, seed=1)


def test_a_straight_curve_gives_its_direction(surface, at):
    points = np.array([[1, 1, 0.3], [2, 1.5, 0.3], [3, 2, 0.6]])
    found = surface.curve_directions(points, None, at.face, at.uv)
    assert found.dtype == np.float64
    expected = np.array([2, 1, 0]) / np.sqrt(5)
    np.testing.assert_allclose(found, np.tile(expected, (len(at.face), 1)), atol=1e-7)
    rounded = surface.curve_directions(points, [0, 3], at.face, at.uv, dtype=np.float32)
    np.testing.assert_array_equal(rounded, found.astype(np.float32))


def test_curves_do_not_hang_together_unless_offsets_say_so(surface, at):
    up = [[1, 0, 0], [1, 4, 0]]
    points = [*up, [3, 0, 0], [3, 4, 0]]
    apart = surface.curve_directions(points, [0, 2, 4], at.face, at.uv)
    np.testing.assert_allclose(apart, np.tile([0, 1, 0], (len(at.face), 1)), atol=1e-7)
    joined = surface.curve_directions(points, None, at.face, at.uv)
    assert np.abs(joined - apart).max() > 0.5


def test_threads_and_batches_change_nothing(surface, at):
    points = np.random.default_rng(1).random((9, 3)) * [4, 4, 0.2]
    whole = surface.curve_directions(points, None, at.face, at.uv)
    np.testing.assert_array_equal(
        surface.curve_directions(points, None, at.face, at.uv, threads=1), whole
    )
    part = surface.curve_directions(points, None, at.face[7:19], at.uv[7:19])
    np.testing.assert_array_equal(part, whole[7:19])
    assert surface.curve_directions(points, None, [], np.empty((0, 2))).shape == (0, 3)


def test_progress_reaches_1_and_may_end_the_call(surface, at):
    parts = []
    points = [[1, 1, 0], [2, 2, 0]]
    surface.curve_directions(points, None, at.face, at.uv, progress=parts.append)
    assert parts == sorted(parts)
    assert parts[-1] == 1

    def stop(_part):
        raise KeyError("stop")

    with pytest.raises(KeyError):
        surface.curve_directions(points, None, at.face, at.uv, progress=stop)


@pytest.mark.parametrize(
    ("points", "offsets", "match"),
    [
        ([[0, 0, 0], [1, 1, 0]], [0, 3], "end with the number of rows of points, 2"),
        ([[0, 0, 0], [1, 1, 0]], [1, 2], "begin with 0"),
        ([[0, 0, 0], [1, 1, 0]], [], "begin with 0"),
        ([[0, 0, 0], [1, np.nan, 0]], None, r"row 1: points is \(1, nan, 0\), .* not finite"),
        ([[1, 1, 0], [1, 1, 1]], None, "no part of a curve runs along the surface"),
        (np.empty((0, 3)), None, "no part of a curve"),
        ([[0, 0], [1, 1]], None, r"points has shape \(2, 2\)"),
        (
            [[0, 0, 0], [1, 1, 0], [1e9, 1, 0]],
            None,
            r"^points: the curves would be divided into more than 30000000 pieces, .*"
            r"\(1000000000, 1, 0\) is 999999999 long$",
        ),
    ],
)
def test_curves_that_are_refused(surface, at, points, offsets, match):
    with pytest.raises(ValueError, match=match):
        surface.curve_directions(points, offsets, at.face, at.uv)


def test_locations_that_are_refused(surface):
    points = [[0, 0, 0], [1, 1, 0]]
    with pytest.raises(ls.LocationError):
        surface.curve_directions(points, None, [99], [[0.5, 0.5]])
    with pytest.raises(TypeError):
        surface.curve_directions(points, [0.0, 2.0], [0], [[0.5, 0.5]])
