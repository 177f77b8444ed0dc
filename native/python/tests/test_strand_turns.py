# SPDX-License-Identifier: Apache-2.0
"""Strands that move with their roots and turn by the smallest angle."""

import limitsurf as ls
import numpy as np
import pytest


def vectors(count, seed=1):
    return np.random.default_rng(seed).normal(size=(count, 3))


def unit(rows):
    return rows / np.linalg.norm(rows, axis=-1, keepdims=True)


def test_turns_are_rotations_by_the_smallest_angle():
    source, target = vectors(500), vectors(500, 2)
    turns = ls.shortest_turns(source, target)
    assert turns.shape == (500, 3, 3)
    assert turns.dtype == np.float64
    turned = np.einsum("nij,nj->ni", turns, unit(source))
    np.testing.assert_allclose(turned, unit(target), atol=1e-13)
    cosine = np.einsum("ni,ni->n", unit(source), unit(target))
    np.testing.assert_allclose((np.einsum("nii->n", turns) - 1) / 2, cosine, atol=1e-13)
    identity = np.tile(np.eye(3), (500, 1, 1))
    np.testing.assert_allclose(turns @ np.swapaxes(turns, 1, 2), identity, atol=1e-13)


def test_turns_where_there_is_no_smallest_angle():
    source = np.array([[0, 0, 2], [np.nan, 0, 0], [0, 0, 1]])
    target = np.array([[0, 0, -1], [0, 0, 1], [0, 0, 0]])
    opposite, without, nowhere = ls.shortest_turns(source, target)
    np.testing.assert_allclose(opposite @ [0, 0, 1], [0, 0, -1], atol=1e-15)
    np.testing.assert_allclose(np.linalg.det(opposite), 1)
    np.testing.assert_array_equal(without, np.eye(3))
    assert np.isnan(nowhere).all()


def test_quaternions_become_matrices():
    half = np.sqrt(0.5)
    found = ls.rotation_matrices([[1, 0, 0, 0], [half, 0, 0, half], [0, 3, 0, 0], [0, 0, 0, 0]])
    quarter = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    expected = [np.eye(3), quarter, np.diag([1, -1, -1]), np.full((3, 3), np.nan)]
    np.testing.assert_allclose(found, expected, atol=1e-15)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_strands_move_with_their_roots(dtype):
    points, roots, new_roots = (vectors(n, n).astype(dtype) for n in (12, 5, 5))
    new_roots = new_roots[::-1]
    turns = ls.shortest_turns(vectors(5, 8), vectors(5, 9))
    offsets = np.array([0, 4, 4, 9, 10, 12])
    moved = ls.move_strands(points, offsets, roots, new_roots, turns)
    strand = np.repeat(np.arange(5), np.diff(offsets))
    arms = points.astype(np.float64) - roots[strand]
    expected = new_roots[strand] + np.einsum("nij,nj->ni", turns[strand], arms)
    np.testing.assert_allclose(moved, expected, atol=1e-14)
    alone = ls.move_strands(roots, None, roots, new_roots, turns)
    np.testing.assert_array_equal(alone, new_roots)
    none = np.empty((0, 3))
    assert ls.move_strands(none, [0], none, none, turns[:0]).shape == (0, 3)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda p, t: ls.shortest_turns(p, p[:2]),
            "target has 2 rows; expected 3, as many as source has",
        ),
        (lambda p, t: ls.shortest_turns(p[:, :2], p), r"source has shape \(3, 2\)"),
        (lambda p, t: ls.rotation_matrices(p), r"quaternions has shape \(3, 3\)"),
        (
            lambda p, t: ls.move_strands(p, None, p[:2], p, t),
            "roots has 2 rows; expected 3, as many as turns has",
        ),
        (
            lambda p, t: ls.move_strands(p, None, p, p[:2], t),
            "new_roots has 2 rows; expected 3, as many as turns has",
        ),
        (
            lambda p, t: ls.move_strands(p[:2], None, p, p, t),
            "points has 2 rows; expected 3, as many as turns has",
        ),
        (lambda p, t: ls.move_strands(p, [0, 3], p, p, t), "2 offsets for 3 strands; expected 4"),
        (lambda p, t: ls.move_strands(p, [0, 2, 1, 3], p, p, t), r"offsets\[2\] is 1, less than"),
        (lambda p, t: ls.move_strands(p, [1, 2, 2, 3], p, p, t), r"offsets\[0\] is 1; expected 0"),
        (lambda p, t: ls.move_strands(p, [0, 1, 2, 9], p, p, t), "points has 3 rows; expected 9"),
        (lambda p, t: ls.move_strands(p, None, p, p, t[0]), r"turns has shape \(3, 3\)"),
    ],
)
def test_errors(call, message):
    with pytest.raises(ValueError, match=message):
        call(vectors(3), np.tile(np.eye(3), (3, 1, 1)))
