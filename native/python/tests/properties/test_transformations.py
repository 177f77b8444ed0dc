# SPDX-License-Identifier: Apache-2.0
"""The surface moves as its control mesh does. (Powers of two: test_scale.py, to the bit.)"""

import numpy as np
from random_meshes import cages, holds_for, places, seeds, whole

PLACES = 60


@holds_for(cage=cages(), seed=seeds, power=whole(-100, 100))
def test_affine_maps_of_the_cage_are_affine_maps_of_the_surface(cage, seed, power):
    rng = np.random.default_rng(seed)
    scale = 10.0**power
    matrix = scale * (rng.normal(size=(3, 3)) + 2 * np.eye(3))
    offset = scale * rng.normal(size=3)
    surface, moved = cage.surface(), cage.moved(matrix, offset)
    at = places(surface, PLACES, seed)
    before, after = surface.evaluate(*at, 2), moved.surface().evaluate(*at, 2)
    # One rounding of the moved vertices, and those of two evaluations.
    size = np.abs(moved.positions).max() + moved.diagonal()
    wrong = np.abs(after.position - (before.position @ matrix.T + offset))
    assert wrong.max() <= 1e-12 * size
    for name in ("du", "dv"):
        was, now = getattr(before, name), getattr(after, name)
        assert np.array_equal(np.isfinite(was), np.isfinite(now)), name
        finite = np.isfinite(was).all(1)
        with np.errstate(over="ignore"):
            wrong = np.abs(now[finite] - was[finite] @ matrix.T)
        largest = np.abs(now[finite]).max(initial=0) + size
        assert wrong.max(initial=0) <= 1e-11 * largest, name


@holds_for(cage=cages(), seed=seeds, power=whole(-100, 100))
def test_lengths_and_areas_follow_the_scale(cage, seed, power):
    scale = 10.0**power
    surface, scaled = cage.surface(), cage.moved(scale * np.eye(3), 0).surface()
    np.testing.assert_allclose(scaled.area(), scale**2 * surface.area(), rtol=1e-6)
    np.testing.assert_allclose(
        scaled.bounds(), scale * surface.bounds(), rtol=0, atol=1e-12 * scale * cage.diagonal()
    )
    np.testing.assert_allclose(
        scaled.edge_curves().lengths, scale * surface.edge_curves().lengths, rtol=1e-9
    )
    points = np.random.default_rng(seed).normal(size=(20, 3)) * cage.diagonal()
    near, far = surface.closest(points), scaled.closest(scale * points)
    np.testing.assert_allclose(
        far.distance, scale * near.distance, rtol=1e-10, atol=1e-12 * scale * cage.diagonal()
    )
