# SPDX-License-Identifier: Apache-2.0
"""Paths on the surface: laid, fitted, smoothed, divided. The truth is a flat sheet, sheets that can
be unrolled, and dense samples of everything else.
"""

import itertools

import limitsurf as ls
import numpy as np
import pytest
import shapes

TOLERANCES = [1e-2, 1e-3, 1e-4]


def sheet(columns, rows, height, size=1.0):
    """A surface over [0, size]^2 (less at its rounded corners), bent by a function of x and y."""
    y, x = np.mgrid[: rows + 1, : columns + 1].reshape(2, -1).astype(float)
    x, y = size * x / columns, size * y / rows
    return ls.LimitSurface(
        ls.ControlMesh.from_faces(
            np.stack([x, y, height(x, y)], 1), shapes.grid_faces(columns, rows)
        )
    )


@pytest.fixture(scope="module")
def flat():
    return sheet(4, 4, lambda x, y: 0 * x)


@pytest.fixture(scope="module")
def wavy():
    return sheet(16, 16, lambda x, y: 0.1 * np.sin(7 * x) * np.cos(5 * y))


ZIGZAG = np.array([[0.2, 0.2, 0.2], [0.5, 0.8, 0.0], [0.8, 0.3, 0.15]])


def polyline_distance(points, position):
    """The distances of points from a polyline."""
    a, along = position[:-1], np.diff(position, axis=0)
    squared = np.maximum(np.einsum("ij,ij->i", along, along), 1e-300)
    nearest = np.empty(len(points))
    for begin in range(0, len(points), 200):
        arm = points[begin : begin + 200, None] - a
        t = np.clip(np.einsum("nij,ij->ni", arm, along) / squared, 0, 1)
        nearest[begin : begin + 200] = np.linalg.norm(arm - t[..., None] * along, axis=2).min(1)
    return nearest


def segments(position, count=60):
    """`count` points on each segment of a polyline, (n, 3)."""
    t = np.linspace(0, 1, count)[None, :, None]
    return ((1 - t) * position[:-1, None] + t * position[1:, None]).reshape(-1, 3)


def bezier(fit, position, count=100):
    """Points on the segments of a fitted Bezier curve, (k - 1, count, 3)."""
    t = np.linspace(0, 1, count)[None, :, None]
    p = position[fit.rows]
    a, b, c, d = (
        each[:, None] for each in (p[:-1], fit.handle_right[:-1], fit.handle_left[1:], p[1:])
    )
    s = 1 - t
    return s**3 * a + 3 * s * s * t * b + 3 * s * t * t * c + t**3 * d


def circle(centre, radius):
    """The control points and handles of a nearly round Bezier curve."""
    at = radius * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    along = 0.5523 * radius * np.array([[0, 1, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]])
    points = np.array(centre) + at
    return points, points - along, points + along


def test_bezier_curve_is_laid_straight_down_on_a_flat_sheet(flat):
    points, left, right = circle([0.5, 0.5, 0.3], 0.25)
    laid = flat.lay_path(points, 1e-4, handle_left=left, handle_right=right, closed=True)
    assert laid.closed.tolist() == [True]
    assert laid.offsets.tolist() == [0, len(laid.face)]
    np.testing.assert_array_equal(laid.position[0], laid.position[-1])
    number = np.minimum(laid.place.astype(int), 3)
    t = (laid.place - number)[:, None]
    after = (number + 1) % 4
    s = 1 - t
    exact = (
        s**3 * points[number]
        + 3 * s * s * t * right[number]
        + 3 * s * t * t * left[after]
        + t**3 * points[after]
    )
    np.testing.assert_allclose(laid.position, exact * [1, 1, 0], atol=1e-12)
    assert laid.deviation[0] < 1e-12
    dense = np.concatenate([segments(np.stack([a, b])) for a, b in itertools.pairwise(exact)])
    on = laid.place  # every point of the given curve, seen from above, is near the polyline
    assert np.all(np.diff(on) > 0)
    assert polyline_distance(dense * [1, 1, 0], laid.position).max() <= 1e-4


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_path_is_within_the_tolerance_everywhere(wavy, tolerance):
    laid = wavy.lay_path(ZIGZAG, tolerance)
    assert len(laid) == 1
    on = wavy.evaluate(laid.face, laid.uv)
    np.testing.assert_array_equal(laid.position, on.position)
    farthest = wavy.closest(segments(laid.position)).distance.max()
    assert farthest <= tolerance
    assert 0.99 * farthest <= laid.deviation[0] <= 1.001 * farthest
    # the projection of the given line, too
    feet = wavy.closest(segments(ZIGZAG, 500)).position
    assert polyline_distance(feet, laid.position).max() <= tolerance
    # control points are rows
    rows = np.searchsorted(laid.place, [0, 1, 2])
    np.testing.assert_array_equal(laid.place[rows], [0, 1, 2])
    np.testing.assert_array_equal(laid.position[rows], wavy.closest(ZIGZAG).position)


def test_number_of_points_grows_with_the_root_of_the_precision(wavy):
    counts = [len(wavy.lay_path(ZIGZAG, tolerance).face) for tolerance in TOLERANCES]
    for fewer, more in itertools.pairwise(counts):
        assert 2 < more / fewer < 5  # a tenth of the tolerance: the root of 10


def test_steps_are_short_where_that_is_asked(flat):
    laid = flat.lay_path([[0.2, 0.2, 0], [0.8, 0.5, 0]], 1e-3, max_step=0.01)
    steps = np.linalg.norm(np.diff(laid.position, axis=0), axis=1)
    assert steps.max() <= 0.01
    assert len(steps) <= 2 * 0.6708 / 0.01


def test_endless_paths_are_refused(flat):
    for step in (1e-9, 1e-300):
        with pytest.raises(ValueError, match=rf"^max_step is {step!r} and .* ten million points$"):
            flat.lay_path(ZIGZAG, 0.1, max_step=step)


def test_curves_of_a_batch_do_not_depend_on_each_other(wavy):
    rng = np.random.default_rng(3)
    counts = rng.integers(2, 7, 20)
    offsets = np.concatenate([[0], np.cumsum(counts)])
    points = rng.uniform(0.1, 0.9, (offsets[-1], 3)) * [1, 1, 0.3]
    together = wavy.lay_path(points, 1e-3, offsets=offsets)
    again = wavy.lay_path(points, 1e-3, offsets=offsets, threads=1)
    for name in ("face", "uv", "position", "place", "offsets", "curve", "closed", "deviation"):
        np.testing.assert_array_equal(getattr(together, name), getattr(again, name))
    for path in range(len(together)):
        curve = together.curve[path]
        if np.count_nonzero(together.curve == curve) > 1:
            continue
        alone = wavy.lay_path(points[offsets[curve] : offsets[curve + 1]], 1e-3)
        rows = slice(*together.offsets[path : path + 2])
        np.testing.assert_array_equal(together.position[rows], alone.position)


def groove():
    """Two flat walls that meet in an infinitely sharp edge along x = 1/2, at right angles."""
    x = np.array([0, 0.25, 0.5, 0.75, 1])
    grid = [(a, b, abs(a - 0.5)) for b in x for a in x]
    crease = ([[2 + 5 * i, 7 + 5 * i] for i in range(4)], [10.0] * 4)
    return ls.LimitSurface(
        ls.ControlMesh.from_faces(grid, shapes.grid_faces(4, 4), edge_sharpness=crease)
    )


def test_path_goes_down_into_a_groove_that_projection_jumps_over():
    surface = groove()
    # from wall to wall: every point of the line is as far from both at x = 1/2
    laid = surface.lay_path([[0.3, 0.4, 0.3], [0.7, 0.6, 0.3]], 1e-3)
    assert len(laid) == 1
    assert laid.deviation[0] <= 1e-3
    assert surface.closest(segments(laid.position)).distance.max() <= 1e-3
    assert laid.position[:, 2].min() < 1e-3  # it reaches the bottom
    assert laid.position[0, 0] < 0.5 < laid.position[-1, 0]


def slab(thickness):
    """A closed, thin, flat box."""
    corners = [[x, y, z * thickness] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return ls.LimitSurface(ls.ControlMesh.from_faces(np.array(corners, float), faces))


def test_path_ends_where_the_surface_has_no_way_on():
    surface = slab(0.05)
    laid = surface.lay_path([[0.3, 0.5, 1], [0.5, 0.5, 1], [0.5, 0.5, -1], [0.7, 0.5, -1]], 1e-3)
    assert len(laid) == 2
    assert laid.curve.tolist() == [0, 0]
    assert not laid.closed.any()
    above, below = (laid.position[a:b] for a, b in itertools.pairwise(laid.offsets))
    assert above[:, 2].min() > 0.025 > below[:, 2].max()
    assert min(len(above), len(below)) >= 2


def test_path_goes_around_a_rim():
    surface = slab(0.05)
    laid = surface.lay_path([[0.3, 0.5, 0.1], [1.5, 0.5, 0.025], [0.3, 0.5, -0.1]], 1e-3)
    assert len(laid) == 1
    assert surface.closest(segments(laid.position)).distance.max() <= 1e-3


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("offset", [0.0, 0.02, -0.02])
def test_fitted_curves_are_within_the_tolerance(wavy, tolerance, offset):
    points, left, right = circle([0.5, 0.5, 0.1], 0.3)
    path = wavy.lay_path(points, tolerance / 4, handle_left=left, handle_right=right)
    for kind in ("bezier", "poly"):
        fit = wavy.fit_path(path.face, path.uv, tolerance, kind=kind, offset=offset)
        on = wavy.evaluate(path.face, path.uv, derivatives=1)
        beside = on.position + offset * on.normal
        curve = segments(beside[fit.rows]) if kind == "poly" else bezier(fit, beside)
        off = np.abs(wavy.closest(curve.reshape(-1, 3)).distance - abs(offset))
        assert off.max() <= tolerance
        assert fit.deviation <= tolerance
        assert polyline_distance(beside[::5], curve.reshape(-1, 3)).max() <= 0.61 * tolerance
        assert fit.rows[0] == 0
        assert fit.rows[-1] == len(path.face) - 1
        assert np.all(np.diff(fit.rows) > 0)
        if kind == "bezier":
            # as it is drawn, by chords
            t = np.linspace(0, 99, fit.resolution + 1)
            knots = bezier(fit, beside)[:, np.round(t).astype(int)]
            drawn = np.concatenate([segments(piece, 20) for piece in knots])
            off = np.abs(wavy.closest(drawn).distance - abs(offset))
            assert off.max() <= 1.02 * tolerance  # places were rounded to samples


def test_bezier_curves_are_smooth_and_need_few_points(wavy):
    points, left, right = circle([0.5, 0.5, 0.1], 0.3)
    path = wavy.lay_path(points, 2.5e-5, handle_left=left, handle_right=right, closed=True)
    fit = wavy.fit_path(path.face, path.uv, 1e-4, closed=True)
    poly = wavy.fit_path(path.face, path.uv, 1e-4, kind="poly", closed=True)
    assert poly.handle_left is None
    assert len(fit.rows) < len(poly.rows) / 2
    on = wavy.evaluate(path.face[fit.rows], path.uv[fit.rows], derivatives=1)
    back, ahead = on.position - fit.handle_left, fit.handle_right - on.position
    np.testing.assert_array_equal(fit.handle_left[0], fit.handle_left[-1])
    for each in (back, ahead):
        each /= np.linalg.norm(each, axis=1, keepdims=True)
        assert np.abs(np.einsum("ij,ij->i", each, on.normal)).max() < 1e-6
    assert np.einsum("ij,ij->i", back, ahead).min() > 1 - 1e-9


def test_fit_of_a_straight_line_is_a_straight_line(flat):
    path = flat.lay_path([[0.2, 0.2, 0], [0.8, 0.5, 0]], 1e-4, max_step=0.02)
    for kind in ("bezier", "poly"):
        fit = flat.fit_path(path.face, path.uv, 1e-4, kind=kind)
        assert fit.rows.tolist() == [0, len(path.face) - 1]
        assert fit.deviation < 1e-12
        assert fit.error < 1e-12
        assert fit.resolution == 1 or kind == "poly"


def test_corners_are_kept(flat):
    path = flat.lay_path([[0.2, 0.2, 0], [0.5, 0.7, 0], [0.8, 0.2, 0]], 1e-4, max_step=0.02)
    fit = flat.fit_path(path.face, path.uv, 1e-4)
    assert len(fit.rows) == 3
    np.testing.assert_allclose(path.position[fit.rows[1]], [0.5, 0.7, 0], atol=1e-12)
    np.testing.assert_allclose(
        np.cross(fit.handle_left[1] - [0.5, 0.7, 0], [0.3, 0.5, 0]), 0, atol=1e-9
    )
    np.testing.assert_allclose(
        np.cross(fit.handle_right[1] - [0.5, 0.7, 0], [0.3, -0.5, 0]), 0, atol=1e-9
    )
    rounded = flat.fit_path(path.face, path.uv, 1e-2, corner_angle=np.pi)
    back = path.position[rounded.rows] - rounded.handle_left
    ahead = rounded.handle_right - path.position[rounded.rows]
    cosine = np.einsum("ij,ij->i", back, ahead) / np.linalg.norm(back, axis=1)
    assert (cosine / np.linalg.norm(ahead, axis=1))[1:-1].min() > 1 - 1e-9


def test_values_between_control_points_are_kept(flat):
    path = flat.lay_path([[0.2, 0.2, 0], [0.8, 0.5, 0]], 1e-4, max_step=0.005)
    values = np.sin(np.linspace(0, 6, len(path.face)))
    fit = flat.fit_path(path.face, path.uv, 1e-4, kind="poly", values=values, value_tolerance=0.01)
    shown = np.interp(np.arange(len(values)), fit.rows, values[fit.rows])
    assert np.abs(shown - values).max() <= 0.0101
    assert 10 < len(fit.rows) < 60


def test_smoothing_leaves_straight_paths_and_their_spacing(flat):
    x = np.sort(np.random.default_rng(5).uniform(0.2, 0.8, 30))
    path = flat.lay_path(np.stack([x, 0.1 + x / 2, 0 * x], 1), 1e-3)
    smooth = flat.smooth_path(path.face, path.uv, np.ones(30), 20)
    np.testing.assert_allclose(
        flat.evaluate(smooth.face, smooth.uv).position, path.position, atol=1e-12
    )


def test_smoothed_paths_become_straight_lines_of_the_unrolled_sheet():
    """On a sheet that is bent along x alone, the straightest path is straight in arc length."""
    surface = sheet(24, 8, lambda x, y: 0.15 * np.sin(6 * x))
    rng = np.random.default_rng(7)
    count = 33
    x = np.linspace(0.15, 0.85, count)
    start = np.stack([x, 0.3 + 0.4 * (x - 0.15) / 0.7, 0 * x], 1)
    start[1:-1] += rng.normal(0, 0.01, (count - 2, 3))
    hits = surface.closest(start)
    smooth = surface.smooth_path(hits.face, hits.uv, np.ones(count), 4000)
    found = surface.evaluate(smooth.face, smooth.uv).position
    np.testing.assert_array_equal(found[[0, -1]], hits.position[[0, -1]])
    # the arc length of the profile, from dense samples
    dense = surface.ray_cast(
        np.stack([np.linspace(0.05, 0.95, 20001), np.full(20001, 0.5), np.ones(20001)], 1),
        np.tile([0.0, 0, -1], (20001, 1)),
    ).position
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(dense, axis=0), axis=1))])
    along = np.interp(found[:, 0], dense[:, 0], length)
    part = (along - along[0]) / (along[-1] - along[0])
    straight = found[0, 1] + part * (found[-1, 1] - found[0, 1])
    before = np.abs(hits.position[:, 1] - straight).max()
    # a chord of the polyline is off by less than 1e-3 of its length
    assert np.abs(found[:, 1] - straight).max() < 1e-3 < before / 5


def test_weights_say_what_moves_and_closed_paths_move_as_a_whole(wavy):
    points, left, right = circle([0.5, 0.5, 0.1], 0.3)
    path = wavy.lay_path(points, 1e-3, handle_left=left, handle_right=right, closed=True)
    count = len(path.face)
    weights = np.zeros(count)
    weights[3] = 1
    smooth = wavy.smooth_path(path.face, path.uv, weights, closed=True)
    moved = np.abs(wavy.evaluate(smooth.face, smooth.uv).position - path.position).max(axis=1) > 0
    assert np.flatnonzero(moved).tolist() == [3]
    smooth = wavy.smooth_path(path.face, path.uv, np.ones(count), 5, closed=True)
    found = wavy.evaluate(smooth.face, smooth.uv).position
    np.testing.assert_array_equal(found[0], found[-1])
    assert np.abs(found[0] - path.position[0]).max() > 0


def test_even_points_divide_the_length(flat, wavy):
    path = flat.lay_path([[0.2, 0.2, 0], [0.5, 0.7, 0], [0.8, 0.2, 0]], 1e-4)
    even = flat.even_path(path.face, path.uv, 5)
    expected = [[0.2, 0.2, 0], [0.35, 0.45, 0], [0.5, 0.7, 0], [0.65, 0.45, 0], [0.8, 0.2, 0]]
    np.testing.assert_allclose(flat.evaluate(even.face, even.uv).position, expected, atol=1e-12)
    path = wavy.lay_path(ZIGZAG, 1e-5)
    even = wavy.even_path(path.face, path.uv, 400)
    steps = np.linalg.norm(np.diff(wavy.evaluate(even.face, even.uv).position, axis=0), axis=1)
    assert steps.max() / np.median(steps) < 1.01
    assert even.face[0] == path.face[0]
    assert even.face[-1] == path.face[-1]


def refusal(call, *arguments, **keywords):
    with pytest.raises(ValueError, match=".") as caught:
        call(*arguments, **keywords)
    return str(caught.value)


def test_errors_name_what_is_wrong(flat):
    line = [[0.2, 0.2, 0], [0.8, 0.5, 0]]
    assert "tolerance is 0" in refusal(flat.lay_path, line, 0)
    assert "max_step is 0" in refusal(flat.lay_path, line, 1, max_step=0)
    assert "row 1: points is (nan" in refusal(flat.lay_path, [[0, 0, 0], [np.nan, 0, 0]], 1)
    assert "together" in refusal(flat.lay_path, line, 1, handle_left=line)
    assert "handle_right has 1 row; expected 2, as many as points has" in refusal(
        flat.lay_path, line, 1, handle_left=line, handle_right=line[:1]
    )
    assert "offsets[2] is 1" in refusal(flat.lay_path, line, 1, offsets=[0, 1, 1, 2])
    assert "offsets must begin with 0" in refusal(flat.lay_path, line, 1, offsets=[0, 3])
    assert "closed has 2 values" in refusal(flat.lay_path, line, 1, closed=[True, False])
    path = flat.lay_path(line, 1e-3)
    assert "kind is 'nurbs'" in refusal(flat.fit_path, path.face, path.uv, 1, kind="nurbs")
    assert "1 points; at least 2" in refusal(flat.fit_path, path.face[:1], path.uv[:1], 1)
    assert "values has 1 row; expected" in refusal(flat.fit_path, path.face, path.uv, 1, values=[1])
    assert "weights[1] is 2" in refusal(flat.smooth_path, path.face, path.uv, [0, 2])
    assert "iterations is -1" in refusal(flat.smooth_path, path.face, path.uv, [0, 1], -1)
    for count in (1, 10_000_001, 2**31 - 1):
        assert f"count is {count}" in refusal(flat.even_path, path.face, path.uv, count)
    with pytest.raises(ls.LocationError, match="row 1"):
        flat.fit_path([0, 99], [[0, 0], [0, 0]], 1)
    with pytest.raises(ls.LocationError, match="row 0"):
        flat.even_path([0, 1], [[2, 0], [0, 0]], 3)


def test_nothing_in_nothing_out_and_one_point(flat):
    laid = flat.lay_path(np.empty((0, 3)), 1)
    assert len(laid) == 0
    assert laid.offsets.tolist() == [0]
    laid = flat.lay_path([[0.5, 0.5, 1]], 1, closed=True)
    assert len(laid.face) == 1
    assert not laid.closed.any()
    twice = flat.lay_path([[0.5, 0.5, 1], [0.5, 0.5, 2]], 1)
    assert twice.place.tolist() == [0, 1]


def test_a_surface_without_faces_is_refused():
    mesh = ls.ControlMesh.from_faces([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], holes=[0])
    with pytest.raises(ls.MeshError, match="no face"):
        ls.LimitSurface(mesh).lay_path([[0, 0, 0], [1, 0, 0]], 1)
