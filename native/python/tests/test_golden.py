# SPDX-License-Identifier: Apache-2.0
"""The promised accuracy, on a few of the meshes of which the C++ tests use all."""

import golden
import limitsurf as ls
import numpy as np
import pytest

ORDERS = [("position",), ("du", "dv"), ("duu", "duv", "dvv")]
ALLOWED = [1e-13, 1e-12, 1e-11]


def length(rows):
    return np.linalg.norm(rows, axis=1)


def away_from_corners(uv):
    return np.minimum(uv, 1 - uv).max(axis=1) >= 1 / 16


@pytest.mark.parametrize(
    "name",
    [
        "cross_smooth",
        "cross_corners",
        "grid_holes_smooth",
        "pentagon_prism_open_corners",
        "triangles_smooth_smooth",
        "interior_valence7",
        "boundary_smooth_valence5",
    ],
)
def test_values_are_reached(name):
    truth = golden.read_golden(golden.path_of(name))
    mesh = ls.ControlMesh.from_faces(
        truth.positions, truth.faces, boundary=truth.boundary, triangles=truth.triangles
    )
    got = ls.LimitSurface(mesh).evaluate(truth.face, truth.uv, derivatives=2)
    diagonal = np.linalg.norm(np.ptp(truth.positions, axis=0))
    for order, names in enumerate(ORDERS):
        scale = np.full(truth.face.max() + 1, diagonal if order == 0 else 0.0)
        if order > 0:
            inner = away_from_corners(truth.uv)
            for quantity in names:
                sizes = np.nan_to_num(length(truth.values[quantity]))
                np.maximum.at(scale, truth.face[inner], sizes[inner])
        for quantity in names:
            expected = truth.values[quantity]
            known = ~np.isnan(expected[:, 0])
            assert known.sum() > 50
            size = scale[truth.face]
            if order > 0:
                size = np.maximum(size, length(expected))
            error = length(getattr(got, quantity) - expected)[known] / size[known]
            assert error.max() <= ALLOWED[order], quantity


@pytest.mark.parametrize("name", golden.names())
def test_files_are_read_whole(name):
    values = golden.read_golden(golden.path_of(name))
    assert len(values.face) == len(values.uv) == len(values.values["normal"])
    assert np.isfinite(values.values["position"]).all()
