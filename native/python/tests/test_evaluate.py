# SPDX-License-Identifier: Apache-2.0
import contextlib
import threading
import tracemalloc

import limitsurf as ls
import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

FIELDS = ("position", "du", "dv", "duu", "duv", "dvv", "normal")
CALLS = {
    "evaluate": lambda surface, face, uv, **options: surface.evaluate(face, uv, 2, **options),
    "frames": lambda surface, face, uv, **options: surface.frames(face, uv, **options),
    "placed_frames": lambda surface, face, uv, **options: surface.placed_frames(
        face, uv, **options
    ),
    "curvature": lambda surface, face, uv, **options: surface.curvature(face, uv, **options),
    "stencils": lambda surface, face, uv, **options: surface.stencils(face, uv, 1, **options),
}
every_call = pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)

SURFACE = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.house()))


@pytest.mark.parametrize("derivatives", [0, 1, 2])
def test_gives_what_was_asked_for(surface, anywhere, derivatives):
    face, uv = anywhere(surface, 50)
    got = surface.evaluate(face, uv, derivatives)
    asked = {0: FIELDS[:1], 1: ("position", "du", "dv", "normal"), 2: FIELDS}[derivatives]
    for name in FIELDS:
        values = getattr(got, name)
        if name in asked:
            assert values.shape == (50, 3)
            assert values.dtype == np.float64
            assert values.flags.c_contiguous
            assert values.flags.writeable
        else:
            assert values is None


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
def test_contiguous_locations_are_not_copied(dtype):
    rows = 100_000
    face, uv = np.zeros(rows, dtype), np.full((rows, 2), 0.5)
    tracemalloc.start()
    try:
        SURFACE.evaluate(face, uv, 1)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    results = 4 * 3 * 8 * rows
    assert results <= peak <= results + 10_000


def test_locations_that_change_meanwhile_break_nothing():
    face, uv = np.zeros(20_000, int), np.full((20_000, 2), 0.5)
    stop = threading.Event()

    def change():
        while not stop.is_set():
            face[::7] = 2**31 - 5
            uv[::5] = np.nan
            face[::7] = uv[::5] = 0

    worker = threading.Thread(target=change)
    worker.start()
    try:
        for _ in range(200):
            with contextlib.suppress(ls.LocationError):
                SURFACE.evaluate(face, uv, 1)
    finally:
        stop.set()
        worker.join()
    assert np.isfinite(SURFACE.evaluate(face, uv, 1).position).all()


@pytest.mark.parametrize("derivatives", [-1, 3, 100])
def test_other_orders_are_value_errors(cube, derivatives):
    with pytest.raises(ValueError, match=str(derivatives)):
        cube.evaluate(0, [[0.5, 0.5]], derivatives)
    with pytest.raises(ValueError, match=str(derivatives)):
        cube.stencils(0, [[0.5, 0.5]], derivatives)


def test_one_face_serves_all_rows(surface):
    uv = np.random.default_rng(0).random((20, 2))
    one = surface.evaluate(0, uv, 2)
    many = surface.evaluate(np.zeros(20, int), uv, 2)
    numpy_int = surface.evaluate(np.int32(0), uv, 2)
    for name in FIELDS:
        np.testing.assert_array_equal(getattr(one, name), getattr(many, name))
        np.testing.assert_array_equal(getattr(one, name), getattr(numpy_int, name))


def test_empty_batches_give_empty_arrays(surface):
    for face in ([], np.zeros(0, np.int64), 0):
        got = surface.evaluate(face, np.zeros((0, 2)), 2)
        for name in FIELDS:
            assert getattr(got, name).shape == (0, 3)
        assert surface.frames(face, np.zeros((0, 2))).shape == (0, 3, 3)
        assert surface.curvature(face, np.zeros((0, 2))).mean.shape == (0,)
        assert surface.stencils(face, np.zeros((0, 2))).offsets.tolist() == [0]


@pytest.mark.parametrize("dtype", ["f4", "f8", ">f8", "f2", "i8"])
@pytest.mark.parametrize("layout", ["C", "F", "strided", "reversed", "read-only"])
@pytest.mark.parametrize("face_dtype", ["i1", "u1", "i4", ">i4", "i8", "u8"])
def test_locations_come_in_any_type_and_layout(anywhere, dtype, layout, face_dtype):
    face, uv = anywhere(SURFACE, 30)
    uv = np.round(uv * 8) / 8 if dtype != "i8" else np.round(uv)
    expected = SURFACE.evaluate(face, uv).position
    face, uv = face.astype(face_dtype), uv.astype(dtype)
    if layout == "F":
        uv = np.asfortranarray(uv)
    elif layout == "strided":
        face, uv = np.repeat(face, 3)[::3], np.repeat(np.repeat(uv, 3, 0), 2, 1)[::3, ::2]
    elif layout == "reversed":
        face, uv = face[::-1].copy()[::-1], uv[::-1].copy()[::-1]
    elif layout == "read-only":
        face.flags.writeable = uv.flags.writeable = False
    np.testing.assert_array_equal(SURFACE.evaluate(face, uv).position, expected)


@every_call
@pytest.mark.parametrize("shape", [(3,), (4, 3), (2, 2, 2), (4,), (), (2, 4)])
def test_wrong_shapes_of_uv_are_quoted(call, shape):
    with pytest.raises(ls.LocationError) as error:
        call(SURFACE, 0, np.full(shape, 0.5))
    assert str(shape) in str(error.value)


@every_call
@pytest.mark.parametrize("shape", [(3,), (5,), (0,), (4, 1), (1,), (2, 2)])
def test_wrong_shapes_of_face_are_quoted(call, shape):
    with pytest.raises(ls.LocationError) as error:
        call(SURFACE, np.zeros(shape, int), np.full((4, 2), 0.5))
    assert str(shape) in str(error.value)


@every_call
@pytest.mark.parametrize("dtype", [float, bool, complex, str])
def test_float_faces_are_type_errors(call, dtype):
    with pytest.raises(TypeError):
        call(SURFACE, np.zeros(2, dtype), np.full((2, 2), 0.5))
    with pytest.raises(TypeError):
        call(SURFACE, 0.0, np.full((2, 2), 0.5))


@every_call
@pytest.mark.parametrize("dtype", [complex, str, "datetime64[s]"])
def test_uv_is_real(call, dtype):
    with pytest.raises(TypeError):
        call(SURFACE, 0, np.zeros((2, 2), int).astype(dtype))


@every_call
@pytest.mark.parametrize("bad", [-1, 10**6, 2**31, 2**32, 2**40, -(2**40), 2**63 - 1, -(2**63)])
def test_faces_out_of_range_are_named(call, bad):
    face = np.zeros(20, np.int64)
    face[13] = bad
    with pytest.raises(ls.LocationError, match="row 13") as error:
        call(SURFACE, face, np.full((20, 2), 0.5))
    assert str(bad) in str(error.value)
    with pytest.raises(ls.LocationError, match="row 0"):
        call(SURFACE, bad, np.full((20, 2), 0.5))


@pytest.mark.parametrize("bad", [2**63, 2**64 - 1, 2**64, 2**100, -(2**64)])
def test_faces_beyond_64_bits_are_errors(bad):
    with pytest.raises((ls.LocationError, OverflowError)):
        SURFACE.evaluate(bad, [[0.5, 0.5]])
    # numpy makes floats of a list that no integer type holds.
    with pytest.raises((ls.LocationError, OverflowError, TypeError)):
        SURFACE.evaluate([0, bad], [[0.5, 0.5]] * 2)


@every_call
@pytest.mark.parametrize("column", [0, 1])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, -1e-17, -5e-324, 1 + 2**-52, 2])
def test_uv_out_of_range_is_named(call, column, bad):
    uv = np.full((20, 2), 0.5)
    uv[7, column] = bad
    uv[15] = 9  # not the first
    with pytest.raises(ls.LocationError, match="row 7"):
        call(SURFACE, 0, uv)


@pytest.mark.parametrize("good", [0.0, -0.0, 5e-324, 1e-300, 1 - 2**-53, 1.0])
def test_the_whole_unit_square_is_fine(surface, good):
    for uv in ([[good, 0.3]], [[0.3, good]], [[good, good]]):
        assert np.isfinite(surface.evaluate(0, uv).position).all()


def test_float32_rounds_the_output(surface, anywhere):
    face, uv = anywhere(surface, 40)
    for dtype in (np.float32, "float32", np.dtype("f4")):
        double, single = surface.evaluate(face, uv, 2), surface.evaluate(face, uv, 2, dtype=dtype)
        for name in FIELDS:
            assert getattr(single, name).dtype == np.float32
            np.testing.assert_array_equal(
                getattr(single, name), getattr(double, name).astype(np.float32)
            )
        frames = surface.frames(face, uv, dtype=dtype)
        np.testing.assert_array_equal(frames, surface.frames(face, uv).astype(np.float32))
        assert surface.curvature(face, uv, dtype=dtype).k1.dtype == np.float32


@pytest.mark.parametrize("dtype", [int, np.float16, complex, str])
def test_other_dtypes_are_type_errors(cube, dtype):
    with pytest.raises(TypeError):
        cube.evaluate(0, [[0.5, 0.5]], dtype=dtype)


@every_call
def test_negative_threads_are_value_errors(call):
    with pytest.raises(ValueError, match="-1"):
        call(SURFACE, 0, [[0.5, 0.5]], threads=-1)


@settings(max_examples=50, deadline=None)
@given(st.data())
def test_a_location_has_one_result(data):
    """Whatever the batch and the number of threads."""
    n = data.draw(st.integers(1, 200))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    face = rng.integers(0, SURFACE.face_count, n)
    uv = rng.random((n, 2)) * 2.0 ** -rng.integers(0, 40, (n, 1))
    whole = SURFACE.evaluate(face, uv, 2, threads=1)
    order = rng.permutation(n)
    part = order[: data.draw(st.integers(1, n))]
    other = SURFACE.evaluate(face[part], uv[part], 2, threads=data.draw(st.integers(0, 5)))
    for name in FIELDS:
        assert getattr(other, name).tobytes() == getattr(whole, name)[part].tobytes()


@settings(max_examples=100, deadline=None)
@given(
    st.integers(0, SURFACE.face_count - 1),
    st.floats(0, 1, allow_subnormal=True),
    st.floats(0, 1, allow_subnormal=True),
)
def test_any_location_has_a_position_and_a_frame(face, u, v):
    here = SURFACE.evaluate(face, [[u, v]], 1)
    low, high = SURFACE.bounds()
    assert ((low - 1e-12 <= here.position) & (here.position <= high + 1e-12)).all()
    frame = SURFACE.frames(face, [[u, v]])[0]
    np.testing.assert_allclose(frame.T @ frame, np.eye(3), atol=1e-13)


def test_positions_can_be_set(surface, mesh, anywhere):
    face, uv = anywhere(surface, 30)
    moved = mesh.positions + np.random.default_rng(1).uniform(-0.2, 0.2, mesh.positions.shape)
    surface.set_positions(np.asfortranarray(moved))
    np.testing.assert_array_equal(surface.positions, moved)
    fresh = ls.LimitSurface(
        ls.ControlMesh(moved, mesh.face_sizes, mesh.face_vertices, boundary=mesh.boundary)
    )
    for name in FIELDS:
        ours = getattr(surface.evaluate(face, uv, 2), name)
        assert ours.tobytes() == getattr(fresh.evaluate(face, uv, 2), name).tobytes()


def test_bad_positions_change_nothing(cube, anywhere):
    face, uv = anywhere(cube, 10)
    before = cube.evaluate(face, uv).position
    broken = cube.positions
    broken[3, 1] = np.nan
    for bad in (broken, cube.positions[:-1], cube.positions[:, :2], cube.positions.ravel()):
        with pytest.raises(ls.MeshError):
            cube.set_positions(bad)
    with pytest.raises(TypeError):
        cube.set_positions(cube.positions.astype(complex))
    with pytest.raises(ValueError, match="-2"):
        cube.set_positions(cube.positions, threads=-2)
    np.testing.assert_array_equal(cube.evaluate(face, uv).position, before)


def test_ptex_faces_are_numbered_in_face_order():
    positions, faces = shapes.house()
    base = [i for i, face in enumerate(faces) for _ in range(1 if len(face) == 4 else len(face))]
    corner = [c for face in faces for c in range(1 if len(face) == 4 else len(face))]
    assert SURFACE.face_count == len(base)
    np.testing.assert_array_equal(SURFACE.base_face, base)
    np.testing.assert_array_equal(SURFACE.corner, corner)


def test_refused_faces_are_told_and_spoil_nothing():
    positions, faces = shapes.grid(4, 4)
    twice = [*faces[:-1].tolist(), [23, 24, 23]]
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, twice, holes=[0]))
    assert isinstance(surface.refused, dict)
    assert {0, 15} <= set(surface.refused)
    assert all(isinstance(reason, str) and reason for reason in surface.refused.values())
    assert "18 Ptex" in repr(surface)
    sound = [face for face in range(15) if face not in surface.refused]
    assert np.isfinite(surface.evaluate(sound, np.full((len(sound), 2), 0.5)).position).all()
    for face in (0, 15, 16, 17):
        with pytest.raises(ls.MeshError, match=str(face)):
            surface.evaluate(face, [[0.5, 0.5]])
        with pytest.raises(ls.MeshError, match=str(face)):
            surface.frames([1, face], [[0.5, 0.5]] * 2)
