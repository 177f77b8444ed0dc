# SPDX-License-Identifier: Apache-2.0
"""Fixed samples give what the surface gives, in every pose."""

import threading

import limitsurf as ls
import numpy as np
import pytest


def places(surface, per_face=6):
    rng = np.random.default_rng(2)
    face = np.repeat(np.arange(surface.face_count), per_face)
    uv = rng.random((len(face), 2))
    uv[1::per_face] = 2.0**-12
    uv[2::per_face] = [1, 0.5]
    uv[3::per_face] = [0, 0]
    return face, uv


@pytest.mark.parametrize("derivatives", [0, 1])
def test_follow_every_pose(surface, derivatives):
    face, uv = places(surface)
    samples = surface.fixed_samples(face, uv, derivatives)
    assert len(samples) == len(face)
    assert samples.derivatives == derivatives
    assert samples.vertex_count == len(surface.positions)
    rng = np.random.default_rng(0)
    for moved in (surface.positions, rng.random(surface.positions.shape)):
        surface.set_positions(moved)
        here, got = surface.evaluate(face, uv, derivatives), samples.evaluate(moved)
        np.testing.assert_allclose(got.position, here.position, rtol=0, atol=1e-13)
        for derived, expected in ((got.du, here.du), (got.dv, here.dv)):
            if derivatives:
                np.testing.assert_allclose(derived, expected, rtol=1e-12, atol=1e-12)
            else:
                assert derived is None
        assert got.normal is got.duu is got.duv is got.dvv is None


def test_do_not_pose_the_surface(surface):
    before = surface.positions
    samples = surface.fixed_samples(*places(surface))
    samples.evaluate(before + 1)
    np.testing.assert_array_equal(surface.positions, before)


def test_outlive_the_surface(mesh):
    surface = ls.LimitSurface(mesh)
    at = places(surface)
    expected = surface.evaluate(*at).position
    samples = surface.fixed_samples(*at)
    del surface
    np.testing.assert_allclose(samples.evaluate(mesh.positions).position, expected, atol=1e-13)


def test_give_float32(surface):
    samples = surface.fixed_samples(*places(surface), 1)
    exact = samples.evaluate(surface.positions)
    single = samples.evaluate(surface.positions, dtype="float32")
    for got, expected in ((single.position, exact.position), (single.du, exact.du)):
        assert got.dtype == np.float32
        np.testing.assert_array_equal(got, expected.astype(np.float32))


def test_take_lists_and_other_types(surface):
    samples = surface.fixed_samples(0, [[0.25, 0.5]])
    expected = samples.evaluate(surface.positions).position
    for positions in (
        surface.positions.tolist(),
        np.asfortranarray(surface.positions),
        np.repeat(surface.positions, 2, axis=0)[::2],
    ):
        np.testing.assert_array_equal(samples.evaluate(positions).position, expected)


def test_depend_on_no_thread(surface):
    samples = surface.fixed_samples(*places(surface), 1, threads=1)
    other = surface.fixed_samples(*places(surface), 1)
    one = samples.evaluate(surface.positions, threads=1)
    all_cores = other.evaluate(surface.positions)
    np.testing.assert_array_equal(one.position, all_cores.position)
    np.testing.assert_array_equal(one.dv, all_cores.dv)


def test_serve_several_threads_at_once():
    # The samples around a vertex of 70 faces share a pose that each call makes for itself.
    turn = np.arange(70) * 2 * np.pi / 70
    ring = np.stack([np.cos(turn), np.sin(turn), 0.1 * np.sin(5 * turn)], -1)
    positions = np.concatenate([[[0, 0, 1]], ring])
    faces = [[0, 1 + i, 1 + (i + 1) % 70] for i in range(70)]
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    at = places(surface, 20)
    samples = surface.fixed_samples(*at)
    poses = [positions * (1 + i) for i in range(4)]
    expected = [samples.evaluate(pose).position for pose in poses]
    wrong = []

    def work(i):
        for _ in range(20):
            if not np.array_equal(samples.evaluate(poses[i]).position, expected[i]):
                wrong.append(i)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(len(poses))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []
    np.testing.assert_allclose(expected[0], surface.evaluate(*at).position, atol=1e-13)


def test_say_what_is_wrong(surface):
    samples = surface.fixed_samples([0], [[0.5, 0.5]])
    count = len(surface.positions)
    with pytest.raises(ls.MeshError, match=rf"has shape \(2, 3\); expected \({count}, 3\)"):
        samples.evaluate(np.zeros((2, 3)))
    broken = surface.positions
    broken[1, 2] = np.nan
    with pytest.raises(ls.MeshError, match="vertex 1 has position .*must be finite"):
        samples.evaluate(broken)
    with pytest.raises(ls.LocationError, match=r"row 1: uv is \(2, 0\)"):
        surface.fixed_samples([0, 0], [[0, 0], [2, 0]])
    with pytest.raises(ValueError, match="derivatives is 2; expected 0 or 1"):
        surface.fixed_samples([0], [[0, 0]], 2)
    with pytest.raises(TypeError, match="dtype"):
        samples.evaluate(surface.positions, dtype=int)


def test_may_be_none(surface):
    samples = surface.fixed_samples([], [])
    assert len(samples) == 0
    assert samples.evaluate(surface.positions).position.shape == (0, 3)


def test_are_made_by_surfaces(surface):
    with pytest.raises(TypeError):
        ls.FixedSamples()
    with pytest.raises(TypeError, match="cannot pickle 'FixedSamples' object"):
        surface.fixed_samples(0, [[0, 0]]).__reduce__()
