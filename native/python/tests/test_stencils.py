# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest


def applied(stencils, weights, values):
    rows = np.repeat(np.arange(len(stencils.offsets) - 1), np.diff(stencils.offsets))
    result = np.zeros((len(stencils.offsets) - 1, values.shape[1]))
    np.add.at(result, rows, weights[:, None] * values[stencils.indices])
    return result


def places(surface):
    rng = np.random.default_rng(2)
    face = np.repeat(np.arange(surface.face_count), 8)
    uv = rng.random((len(face), 2))
    uv[1::8] = 2.0**-12
    uv[2::8] = [1 - 2.0**-20, 2.0**-21]
    uv[3::8] = [1, 0.5]
    uv[4::8] = [0, 0]
    uv[5::8] = [1, 1]
    return face, uv


def test_are_compressed_rows(surface, mesh):
    face, uv = places(surface)
    s = surface.stencils(face, uv, derivatives=1)
    assert s.offsets.shape == (len(face) + 1,)
    assert s.offsets.dtype == np.int64
    assert s.offsets[0] == 0
    assert (np.diff(s.offsets) > 0).all()
    n = s.offsets[-1]
    for array in (s.indices, s.weights, s.du_weights, s.dv_weights):
        assert array.shape == (n,)
    assert np.issubdtype(s.indices.dtype, np.integer)
    assert s.indices.min() >= 0
    assert s.indices.max() < len(mesh.positions)


def test_without_derivatives_have_none(surface):
    s = surface.stencils(*places(surface))
    assert s.du_weights is None
    assert s.dv_weights is None


def test_partition_unity(surface):
    face, uv = places(surface)
    s = surface.stencils(face, uv, derivatives=1)
    ones = np.ones((len(surface.positions), 1))
    np.testing.assert_allclose(applied(s, s.weights, ones), 1, atol=1e-13)
    for weights in (s.du_weights, s.dv_weights):
        sums = applied(s, weights, ones)
        scale = applied(s, np.abs(weights), ones)
        known = ~np.isnan(sums)
        assert (np.abs(sums)[known] <= 1e-13 * (1 + scale[known])).all()


def test_times_the_cage_are_the_evaluation(surface):
    face, uv = places(surface)
    s, here = surface.stencils(face, uv, derivatives=1), surface.evaluate(face, uv, 1)
    cage = surface.positions
    np.testing.assert_allclose(applied(s, s.weights, cage), here.position, atol=1e-13)
    for weights, expected in ((s.du_weights, here.du), (s.dv_weights, here.dv)):
        np.testing.assert_allclose(applied(s, weights, cage), expected, rtol=1e-12, atol=1e-12)


def test_serve_every_pose_and_any_data(surface):
    face, uv = places(surface)
    s = surface.stencils(face, uv)
    moved = np.random.default_rng(0).random(surface.positions.shape)
    surface.set_positions(moved)
    got = surface.evaluate(face, uv).position
    np.testing.assert_allclose(applied(s, s.weights, moved), got, atol=1e-13)


@pytest.mark.parametrize("n", [1, 2])
def test_join_chunks_of_large_batches(cube, n):
    # More rows than one chunk between looks for Ctrl-C.
    rows = 150_000
    uv = np.tile([[0.3, 0.4]], (rows, 1))
    uv[-n:] = [0.7, 0.1]
    s = cube.stencils(0, uv)
    few = cube.stencils(0, uv[-n - 1 :])
    start = s.offsets[-n - 2]
    np.testing.assert_array_equal(s.indices[start:], few.indices)
    np.testing.assert_array_equal(s.weights[start:], few.weights)
    np.testing.assert_array_equal(s.offsets[-n - 2 :] - start, few.offsets)
