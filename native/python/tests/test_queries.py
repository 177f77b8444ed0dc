# SPDX-License-Identifier: Apache-2.0
"""Closest points and rays: arrays in and out, errors, progress."""

import os
import pickle
import subprocess
import sys
import threading
import time

import beside
import ctrl_c
import limitsurf as ls
import numpy as np
import pytest
import shapes

PART = 32_768  # rows searched between two calls of progress


@pytest.fixture
def points():
    return np.random.default_rng(1).uniform(-1, 3, (200, 3))


@pytest.fixture
def directions():
    return np.random.default_rng(2).normal(size=(200, 3))


def calls(surface, points, directions):
    """The three searches, as functions of keyword arguments."""
    return {
        "closest": lambda **more: surface.closest(points, **more),
        "ray_cast": lambda **more: surface.ray_cast(points, directions, **more),
        "ray_cast_all": lambda **more: surface.ray_cast_all(points, directions, **more),
    }


NAMES = ["closest", "ray_cast", "ray_cast_all"]


def same(a, b):
    return all(
        getattr(a, name).tobytes() == getattr(b, name).tobytes()
        for name in ("face", "uv", "position", "distance", "normal")
    )


def samples(surface, side=24):
    u = np.linspace(0, 1, side)
    uv = np.stack(np.meshgrid(u, u), axis=-1).reshape(-1, 2)
    face = np.repeat(np.arange(surface.face_count), len(uv))
    return surface.evaluate(face, np.tile(uv, (surface.face_count, 1))).position


def test_closest_is_nearer_than_any_sample(surface, points):
    hits = surface.closest(points)
    cloud = samples(surface)
    nearest = np.min(np.linalg.norm(points[:, None] - cloud[None], axis=2), axis=1)
    assert np.all(hits.distance <= nearest + 1e-12)
    assert np.all(hits.distance >= nearest - 0.2)
    at = surface.evaluate(hits.face, hits.uv, derivatives=1)
    assert np.array_equal(hits.position, at.position)
    assert np.array_equal(hits.normal, at.normal, equal_nan=True)
    np.testing.assert_allclose(
        hits.distance, np.linalg.norm(points - hits.position, axis=1), rtol=1e-14, atol=1e-15
    )


def test_closest_of_the_surface_is_itself(surface, anywhere):
    on = surface.evaluate(*anywhere(surface, 500)).position
    assert np.max(surface.closest(on).distance) <= 1e-12 * np.ptp(on, axis=0).max()


def test_rays_through_known_points_hit_them(surface, anywhere):
    target = surface.evaluate(*anywhere(surface, 300)).position
    direction = np.random.default_rng(3).normal(size=target.shape)
    hits = surface.ray_cast_all(target - direction, 7 * direction)
    length = np.linalg.norm(direction, axis=1)
    for ray, distance in enumerate(length):
        own = hits.distance[hits.offsets[ray] : hits.offsets[ray + 1]]
        assert np.min(np.abs(own - distance)) < 1e-9
    first = surface.ray_cast(target - direction, direction)
    assert np.all(first.distance <= length + 1e-9)
    np.testing.assert_allclose(
        target - direction + first.distance[:, None] * direction / length[:, None],
        first.position,
        atol=1e-11,
    )


def test_all_hits_begin_with_the_first(surface, points, directions):
    first = surface.ray_cast(points, directions)
    hits = surface.ray_cast_all(points, directions)
    assert hits.offsets.dtype == np.int64
    assert hits.offsets[0] == 0
    assert hits.offsets[-1] == len(hits)
    counts = np.diff(hits.offsets)
    assert np.array_equal(counts > 0, first.face >= 0)
    begins = hits.offsets[:-1][counts > 0]
    np.testing.assert_allclose(hits.distance[begins], first.distance[counts > 0], atol=1e-12)
    for ray in range(len(points)):
        own = hits.distance[hits.offsets[ray] : hits.offsets[ray + 1]]
        assert np.all(np.diff(own) >= 0)


@pytest.mark.parametrize("name", NAMES)
def test_shapes_and_types(surface, points, directions, name):
    for dtype in (np.float64, np.float32):
        hits = calls(surface, points, directions)[name](dtype=dtype)
        n = len(hits)
        assert name == "ray_cast_all" or n == len(points)
        assert isinstance(hits, ls.RayHits if name == "ray_cast_all" else ls.Hits)
        assert hits.face.dtype == np.int32
        assert hits.face.shape == (n,)
        for array, shape in [
            (hits.uv, (n, 2)),
            (hits.position, (n, 3)),
            (hits.distance, (n,)),
            (hits.normal, (n, 3)),
        ]:
            assert array.dtype == dtype
            assert array.shape == shape
    exact = calls(surface, points, directions)[name]()
    assert np.array_equal(exact.position.astype(np.float32), hits.position, equal_nan=True)
    assert np.array_equal(exact.uv.astype(np.float32), hits.uv, equal_nan=True)


@pytest.mark.parametrize("name", ["closest", "ray_cast"])
def test_where_there_is_nothing_all_is_missing(cube, points, directions, name):
    hits = calls(cube, points + 100, directions)[name](max_distance=1.0)
    assert np.all(hits.face == -1)
    for array in (hits.uv, hits.position, hits.distance, hits.normal):
        assert np.all(np.isnan(array))


def test_max_distance_cuts_off(cube, points, directions):
    everywhere = cube.closest(points)
    limit = float(np.median(everywhere.distance))
    near = cube.closest(points, limit)
    found = everywhere.distance <= limit
    assert np.array_equal(near.face >= 0, found)
    np.testing.assert_allclose(near.distance[found], everywhere.distance[found], atol=1e-12)
    hits = cube.ray_cast_all(points, directions)
    cut = cube.ray_cast_all(points, directions, max_distance=1.5)
    assert len(cut) == np.sum(hits.distance <= 1.5)


@pytest.mark.parametrize("empty", [[], np.zeros((0, 3)), np.zeros((0, 3), np.float32)])
def test_empty_batches(cube, empty):
    for hits in (cube.closest(empty), cube.ray_cast(empty, empty), cube.ray_cast_all(empty, empty)):
        assert len(hits) == 0
        assert hits.face.shape == (0,)
        assert hits.uv.shape == (0, 2)
        assert hits.position.shape == hits.normal.shape == (0, 3)
    assert np.array_equal(cube.ray_cast_all(empty, empty).offsets, [0])
    assert len(cube.closest(empty, facing=empty)) == 0


def test_any_layout_that_numpy_can_view(cube, points, directions):
    expected = cube.closest(points)
    assert same(cube.closest(np.asfortranarray(points)), expected)
    assert same(cube.closest(points.tolist()), expected)
    assert same(cube.closest(points[::-1]), cube.closest(points[::-1].copy()))
    single = points.astype(np.float32)
    assert same(cube.closest(single), cube.closest(single.astype(float)))
    whole = np.array([[1, 2, 3], [-1, 0, 0]])
    assert same(cube.closest(whole), cube.closest(whole.astype(float)))


@pytest.mark.parametrize("name", NAMES)
def test_bits_do_not_depend_on_threads(surface, points, directions, name):
    call = calls(surface, points, directions)[name]
    assert same(call(threads=1), call())
    assert same(call(threads=3), call())


def test_bits_do_not_depend_on_the_batch(cube):
    rng = np.random.default_rng(5)
    many = rng.uniform(-1, 2, (PART + 100, 3))
    hits = cube.closest(many)
    for rows in (slice(0, 1), slice(PART - 3, PART + 5), slice(PART + 99, None)):
        some = cube.closest(many[rows])
        assert some.position.tobytes() == hits.position[rows].tobytes()
        assert some.uv.tobytes() == hits.uv[rows].tobytes()


def test_offsets_count_on_from_part_to_part(cube):
    rng = np.random.default_rng(6)
    origins, directions = rng.uniform(-1, 2, (2, PART + 50, 3))
    hits = cube.ray_cast_all(origins, directions)
    last = cube.ray_cast_all(origins[PART:], directions[PART:])
    begin = hits.offsets[PART]
    assert np.array_equal(hits.offsets[PART:] - begin, last.offsets)
    assert hits.position[begin:].tobytes() == last.position.tobytes()


def test_facing_takes_one_direction_or_one_each(cube, points):
    up = cube.closest(points, facing=[0, 0, 1], max_angle=0.5)
    assert same(
        up, cube.closest(points, facing=np.tile([0, 0, 5.0], (len(points), 1)), max_angle=0.5)
    )
    found = up.face >= 0
    assert found.any()
    assert np.all(up.normal[found][:, 2] >= np.cos(0.5) - 1e-9)
    per_row = np.where(np.arange(len(points))[:, None] % 2 == 0, [0, 0, 1.0], [0, 0, -1.0])
    mixed = cube.closest(points, facing=per_row, max_angle=0.5)
    assert np.array_equal(mixed.position[::2], up.position[::2], equal_nan=True)
    odd = mixed.face[1::2] >= 0
    assert np.all(mixed.normal[1::2][odd][:, 2] <= -np.cos(0.5) + 1e-9)


def test_set_positions_forgets_the_search(cube, points):
    moved = np.array(shapes.cube()[0]) * 2 + [1, 2, 3]
    cube.closest(points)
    cube.ray_cast(points, points)
    cube.set_positions(moved)
    other = ls.LimitSurface(ls.ControlMesh.from_faces(moved, shapes.cube()[1]))
    assert same(cube.closest(points), other.closest(points))
    assert same(cube.ray_cast(points, -points), other.ray_cast(points, -points))


def test_pickled_surfaces_search_alike(cube, points):
    expected = cube.closest(points)
    assert same(pickle.loads(pickle.dumps(cube)).closest(points), expected)


@pytest.mark.parametrize("name", NAMES)
def test_progress_grows_to_1(cube, name):
    rng = np.random.default_rng(7)
    points, directions = rng.uniform(-1, 2, (2, 3 * PART, 3))
    parts, callers = [], set()

    def report(part):
        parts.append(part)
        callers.add(threading.get_ident())

    calls(cube, points, directions)[name](progress=report)
    assert len(parts) >= 3
    assert parts[-1] == 1
    assert all(0 <= a < b <= 1 for a, b in zip(parts, parts[1:], strict=False))
    assert callers == {threading.get_ident()}


@pytest.mark.parametrize("name", NAMES)
def test_what_progress_raises_ends_the_call(cube, name):
    rng = np.random.default_rng(8)
    points, directions = rng.uniform(-1, 2, (2, 3 * PART, 3))

    class EnoughError(Exception):
        pass

    parts = []

    def report(part):
        parts.append(part)
        raise EnoughError

    with pytest.raises(EnoughError):
        calls(cube, points, directions)[name](progress=report)
    assert len(parts) == 1
    assert len(cube.closest(points[:5])) == 5, "the surface still works"


def test_progress_may_use_the_surface(cube):
    points = np.random.default_rng(9).uniform(-1, 2, (2 * PART, 3))
    seen = []
    cube.closest(points, progress=lambda part: seen.append(len(cube.closest(points[:3]))))
    assert seen
    assert set(seen) == {3}


def test_progress_cannot_hang_the_call_that_it_is_told_of():
    program = """
import sys
import limitsurf as ls, numpy as np
positions = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, [[0, 1, 2, 3]]))
try:
    surface.closest(np.ones((40000, 3)), progress=lambda part: surface.set_positions(positions))
except (RuntimeError, ValueError) as error:
    print(error)
"""
    subprocess.run(
        [sys.executable, "-c", program],
        timeout=ctrl_c.LIMIT,
        check=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )


def test_progress_must_be_callable(cube):
    with pytest.raises(TypeError, match="progress"):
        cube.closest([[0, 0, 0]], progress=3)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda s: s.closest([[0, 0, 0], [0, np.nan, 0]]), ValueError, "row 1.*point"),
        (lambda s: s.closest([[0, 0, np.inf]]), ValueError, "row 0.*inf"),
        (lambda s: s.closest(np.zeros((2, 2))), ValueError, "points"),
        (lambda s: s.closest(np.zeros(3)), ValueError, "points"),
        (lambda s: s.closest("points"), (TypeError, ValueError), None),
        (lambda s: s.closest([[1j, 0, 0]]), (TypeError, ValueError), None),
        (lambda s: s.closest([[0, 0, 0]], -1), ValueError, "max_distance"),
        (lambda s: s.closest([[0, 0, 0]], np.nan), ValueError, "max_distance"),
        (lambda s: s.closest([], np.nan), ValueError, "max_distance"),
        (lambda s: s.closest([[0, 0, 0]], facing=[0, 0, 0]), ValueError, "row 0: facing is"),
        (lambda s: s.closest([[0, 0, 0]], facing=[[0, 0, 1]] * 2), ValueError, "facing"),
        (lambda s: s.closest([[0, 0, 0]], facing=[0, 1]), ValueError, "facing"),
        (lambda s: s.closest([[0, 0, 0]], facing=[0, 0, 1], max_angle=4), ValueError, "max_angle"),
        (lambda s: s.closest([[0, 0, 0]], facing=[0, 0, 1], max_angle=-1), ValueError, "max_angle"),
        (lambda s: s.closest([[0, 0, 0]], threads=-1), ValueError, "threads"),
        (lambda s: s.closest([[0, 0, 0]], dtype=int), (TypeError, ValueError), "dtype|float"),
        (lambda s: s.closest([[0, 0, 0]], 1, [0, 0, 1]), TypeError, None),
        (lambda s: s.ray_cast([[0, 0, 0]], [[0, 0, 0]]), ValueError, "row 0.*direction"),
        (lambda s: s.ray_cast([[0, 0, 0]], [[0, np.nan, 0]]), ValueError, "row 0.*direction"),
        (lambda s: s.ray_cast([[np.nan, 0, 0]], [[0, 1, 0]]), ValueError, "row 0.*origin"),
        (lambda s: s.ray_cast([[0, 0, 0]] * 2, [[0, 1, 0]]), ValueError, "directions"),
        (lambda s: s.ray_cast([[0, 0, 0]], [[0, 1, 0]], -2), ValueError, "max_distance"),
        (lambda s: s.ray_cast([], [], -2), ValueError, "max_distance"),
        (lambda s: s.ray_cast_all([[0, 0, 0]], [[0, 0, 0]]), ValueError, "row 0.*direction"),
        (lambda s: s.ray_cast_all([[0, 0, 0]], [[0, 1, 0]], threads=-3), ValueError, "threads"),
    ],
)
def test_errors_say_what_and_where(cube, call, error, message):
    with pytest.raises(error, match=message):
        call(cube)


@pytest.mark.parametrize("row", [5, PART - 1, PART, PART + 1000])
def test_errors_name_the_row_of_the_call(cube, row):
    points, directions = np.random.default_rng(11).uniform(1, 2, (2, PART + 2000, 3))
    points[row, 1] = np.nan
    message = rf"row {row}:"
    with pytest.raises(ValueError, match=message):
        cube.closest(points)
    with pytest.raises(ValueError, match=message):
        cube.ray_cast(points, directions)
    points[row] = 0
    directions[row] = 0
    with pytest.raises(ValueError, match=message):
        cube.ray_cast_all(points, directions)
    with pytest.raises(ValueError, match=message):
        cube.closest(points, facing=directions)


def test_other_threads_run_meanwhile(cube):
    points = np.random.default_rng(10).uniform(-50, 50, (40_000, 3))
    beside.assert_python_goes_on(lambda: cube.closest(points, threads=1))


def test_poses_may_change_between_searches_of_other_threads(points):
    positions, faces = shapes.house()
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    poses = [positions, positions + 1]
    expected = []
    for pose in poses:
        surface.set_positions(pose)
        expected.append(surface.closest(points).position.tobytes())
    wrong = []
    stop = threading.Event()

    def search():
        while not stop.is_set():
            found = surface.closest(points, progress=lambda part: None).position
            if found.tobytes() not in expected:
                wrong.append(1)
            time.sleep(0.005)

    workers = [threading.Thread(target=search) for _ in range(2)]
    for worker in workers:
        worker.start()
    for i in range(100):
        surface.set_positions(poses[i % 2])
    stop.set()
    for worker in workers:
        worker.join()
    assert not wrong


@pytest.mark.parametrize("call", ["closest(points)", "ray_cast(points, points)"])
def test_ctrl_c_ends_a_long_search(call):
    program = f"""
import limitsurf as ls, numpy as np, shapes
positions, faces = shapes.grid(100, 100)
positions[:, 2] = np.sin(positions[:, 0] * positions[:, 1])
surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
points = np.tile(np.random.default_rng(0).uniform(-100, 200, (100_000, 3)), (50, 1))
surface.closest(points[:10])
print("ready", flush=True)
surface.{call}
"""
    assert "KeyboardInterrupt" in ctrl_c.errors_of(program)


# A mesh in a plane with triangles, a fin and a hole, to be squeezed a billion times
THIN_X = [
    -0.2, 1.2, 1.8, 3.1, 4.1, 0.6, 0.9, 1.8, 3.4, 3.8, -0.1, 1.2,
    2.2, 2.9, 3.8, -0.1, 1.5, 2.1, 3.0, 4.3, 0.2, 1.0, 1.8, 2.7,
    3.7, 0.7, 2.4, -0.2, 1.2,
]  # fmt: skip
THIN_Y = [
    0.0, -0.4, 0.0, 0.1, 0.1, 0.5, 0.8, 1.1, 0.5, 1.2, 2.1, 2.0,
    1.8, 2.2, 1.8, 2.9, 2.9, 2.8, 3.2, 2.9, 4.2, 4.0, 4.3, 4.5,
    4.5, 1.3, 3.7, 0.0, -0.4,
]  # fmt: skip
THIN_FACES = [
    [0, 1, 6, 5], [1, 2, 7, 6], [3, 4, 9, 8], [5, 6, 25],
    [6, 11, 25], [11, 10, 25], [10, 5, 25], [6, 7, 12, 11],
    [7, 8, 13], [7, 13, 12], [8, 9, 14, 13], [10, 11, 16, 15],
    [11, 12, 17, 16], [12, 13, 18, 17], [13, 14, 19, 18], [15, 16, 21, 20],
    [16, 17, 22, 21], [17, 18, 26], [18, 23, 26], [23, 22, 26],
    [22, 17, 26], [18, 19, 24, 23], [0, 1, 28, 27],
]  # fmt: skip


def test_searches_one_after_the_other_find_something_on_nearly_a_line():
    """Rounding may hide the place of the last search, near which the next one looks."""
    positions = np.column_stack([THIN_X, 1e-9 * np.array(THIN_Y), 0 * np.array(THIN_X)])
    mesh = ls.ControlMesh.from_faces(positions, THIN_FACES, holes=[15])
    surface = ls.LimitSurface(mesh)
    begin, end = np.array([5.49, -2.45, 2.30]), np.array([-4.47, 6.07, 0.41])
    points = begin + np.linspace(0.43, 0.47, 40_000)[:, None] * (end - begin)
    found = surface.closest(points, threads=1)
    assert (found.face >= 0).all()
    alone = surface.closest(points[::4000])
    np.testing.assert_allclose(found.distance[::4000], alone.distance, rtol=1e-9)
