# SPDX-License-Identifier: Apache-2.0
"""What is made of frames: quaternions, frames in the world, directions that lean, strands."""

import limitsurf as ls
import numpy as np
import pytest

#: kFrameRowError
ERROR = 2e-15


def frames(count, seed=0):
    """Rotations, right to the last digit or two."""
    return ls.rotation_matrices(np.random.default_rng(seed).normal(size=(count, 4)))


def test_quaternions_give_the_rotation_back():
    wanted = np.random.default_rng(1).normal(size=(5000, 4)).astype(np.longdouble)
    wanted[::7, 0] = 0
    wanted[1::7, 1:3] *= 1e-9
    wanted /= np.sqrt((wanted**2).sum(axis=1, keepdims=True))
    w, x, y, z = wanted.T
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    found = ls.quaternions(np.moveaxis(np.array(rotation), 2, 0).astype(np.float64))
    assert (found[:, 0] >= 0).all()
    same, opposite = np.abs(found - wanted), np.abs(found + wanted)
    assert np.minimum(same.max(axis=1), opposite.max(axis=1)).max() <= ERROR


def test_quaternions_of_half_turns():
    turns = np.array([np.diag(d) for d in ([1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1])])
    np.testing.assert_array_equal(np.abs(ls.quaternions(turns)), np.eye(4))


def test_what_is_not_finite_stays_in_its_row():
    rotations = frames(3)
    rotations[1, 2, 2] = np.nan
    found = ls.quaternions(rotations)
    assert np.isnan(found).all(axis=1).tolist() == [False, True, False]


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 0.5, 3), (-1, 1, 1), (0.1, -4, -2)])
def test_frames_in_the_world_stand_on_the_mapped_surface(scale):
    own = frames(1000)
    linear = frames(1, 7)[0] @ np.diag(scale) @ frames(1, 8)[0]
    world = ls.frames_in_world(own, linear)
    tangent, across, normal = np.moveaxis(world, 2, 0)
    for sides in (tangent, across, normal):
        np.testing.assert_allclose((sides**2).sum(axis=1), 1, atol=1e-14)
    mapped = np.einsum("ij,njk->nik", linear, own)
    unit = mapped[:, :, 0] / np.linalg.norm(mapped[:, :, 0], axis=1, keepdims=True)
    np.testing.assert_allclose(tangent, unit, atol=1e-13)
    along = np.einsum("ni,ni->n", normal, mapped[:, :, 1])  # the mapped surface's other direction
    np.testing.assert_allclose(along, 0, atol=1e-13)
    assert (np.einsum("ni,ni->n", across, mapped[:, :, 1]) > 0).all()
    assert (np.einsum("ni,ni->n", normal, mapped[:, :, 2]) > 0).all()


def test_leaning_is_a_turn_about_one_axis():
    own = frames(2000).astype(np.longdouble)
    angles = np.random.default_rng(3).normal(size=(2000, 2))
    angles[:3] = [[0, 0], [1e-200, 0], [0, np.pi]]
    found = ls.leaning(own, angles)
    a, b = angles.astype(np.longdouble).T
    angle = np.sqrt(a * a + b * b)
    sine = np.sinc(angle / np.pi).astype(np.longdouble)
    sine[3:] = np.sin(angle[3:]) / angle[3:]
    expected = np.cos(angle)[:, None] * own[:, :, 2]
    expected += sine[:, None] * (a[:, None] * own[:, :, 0] + b[:, None] * own[:, :, 1])
    assert np.abs(found - expected).max() <= ERROR
    np.testing.assert_array_equal(found[0], own[0, :, 2].astype(np.float64))


def test_leaning_by_large_angles():
    size = 10.0 ** np.arange(13)[:, None]
    angles = size * np.random.default_rng(4).uniform(-1, 1, (13, 2))
    wide = angles.astype(np.longdouble)
    angle = np.sqrt((wide * wide).sum(1))
    expected = np.column_stack([(np.sin(angle) / angle)[:, None] * wide, np.cos(angle)])
    found = ls.leaning(np.broadcast_to(np.eye(3), (13, 3, 3)), angles)
    assert (np.abs(found - expected).max(1) <= ERROR * (1 + angle / 8)).all()
    huge = ls.leaning(np.broadcast_to(np.eye(3), (2, 3, 3)), [[1e200, -1e200], [0, 1e308]])
    np.testing.assert_allclose(np.linalg.norm(huge, axis=1), 1, atol=1e-15)


@pytest.mark.parametrize("points", [1, 2, 3, 8])
def test_straight_strands_are_evenly_spaced(points):
    rng = np.random.default_rng(5)
    roots, along = rng.normal(size=(2, 3000, 3))
    strands = ls.straight_strands(roots, along, points)
    assert strands.shape == (3000, points, 3)
    assert strands.dtype == np.float32
    steps = np.arange(points) / max(points - 1, 1)
    expected = roots[:, None, :] + steps[:, None] * along[:, None, :]
    np.testing.assert_array_equal(strands, expected.astype(np.float32))


def test_straight_strands_are_written_to_the_callers_array():
    roots, along = np.random.default_rng(6).normal(size=(2, 30, 3))
    whole = np.full((40, 4, 3), np.nan, np.float32)
    out = whole[5:35]
    assert ls.straight_strands(roots, along, 4, out) is out
    np.testing.assert_array_equal(out, ls.straight_strands(roots, along, 4))
    assert np.isnan(whole[:5]).all()
    assert np.isnan(whole[35:]).all()


@pytest.mark.parametrize(
    ("out", "error", "message"),
    [
        (np.empty((5, 4, 3)), TypeError, "out is no contiguous array of float32"),
        (np.empty((5, 8, 3), np.float32)[:, ::2], TypeError, "out is no contiguous array"),
        (np.empty((5, 12), np.float32), ValueError, r"out has shape \(5, 12\); expected \(5, 4"),
        (np.empty((4, 4, 3), np.float32), ValueError, r"expected \(5, 4, 3\)"),
    ],
)
def test_other_arrays_do_not_receive_strands(out, error, message):
    with pytest.raises(error, match=message):
        ls.straight_strands(np.zeros((5, 3)), np.ones((5, 3)), 4, out)


def test_threads_do_not_change_a_bit():
    own, angles = frames(10_000), np.random.default_rng(4).normal(size=(10_000, 2))
    linear = np.diag([1.0, -2.0, 0.5])
    for call in (
        lambda threads: ls.quaternions(own, threads=threads),
        lambda threads: ls.frames_in_world(own, linear, threads=threads),
        lambda threads: ls.leaning(own, angles, threads=threads),
        lambda threads: ls.straight_strands(own[:, 0], own[:, 1], 4, threads=threads),
    ):
        one = call(1)
        for threads in (0, 2, 3):
            np.testing.assert_array_equal(call(threads), one)
        with pytest.raises(ValueError, match="threads is -1"):
            call(-1)


def test_empty_arrays():
    assert ls.quaternions([]).shape == (0, 4)
    assert ls.frames_in_world([], np.eye(3)).shape == (0, 3, 3)
    assert ls.leaning([], []).shape == (0, 3)
    assert ls.straight_strands([], [], 5).shape == (0, 5, 3)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda f: ls.quaternions(f[0]), r"rotations has shape \(3, 3\); expected \(n, 3, 3\)"),
        (lambda f: ls.frames_in_world(f, np.eye(4)), r"has shape \(4, 4\); expected \(3"),
        (
            lambda f: ls.leaning(f, np.zeros((2, 2))),
            "angles has 2 rows; expected 5, as many as frames has",
        ),
        (lambda f: ls.leaning(f, np.zeros((5, 3))), r"angles has shape \(5, 3\); expected"),
        (
            lambda f: ls.straight_strands(f[:, 0], f[:4, 0], 2),
            "along has 4 rows; expected 5, as many as roots has",
        ),
        (lambda f: ls.straight_strands(f[:, 0], f[:, 0], 0), "points is 0; expected 1 or more"),
    ],
)
def test_other_shapes_are_value_errors(call, message):
    with pytest.raises(ValueError, match=message):
        call(frames(5))
