# SPDX-License-Identifier: Apache-2.0
"""What large coordinates cost: the same mesh near the origin and far from it (docs/accuracy.md,
First derivatives). The two differ by exact numbers.
"""

import limitsurf as ls
import numpy as np
import pytest
import shapes

SIDE = 6
ROUNDING = 2.0**-53
#: Times ROUNDING and the largest coordinate
FIRST_ERROR, NORMAL_ERROR = 16, 32
#: By how much large coordinates turn a normal that is not NaN, in radians
MOST_TURN = 2.0**-7


def second_error(sharpness: float) -> float:
    return 2.0 ** (7 + sharpness)


def noisy_grid(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.meshgrid(np.arange(SIDE + 1.0), np.arange(SIDE + 1.0))
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], 1)
    i = np.arange(SIDE**2)
    first = i // SIDE * (SIDE + 1) + i % SIDE
    quads = first[:, None] + [0, 1, SIDE + 2, SIDE + 1]
    return positions + rng.uniform(-0.3, 0.3, positions.shape), quads


def mesh(kind: str, rng: np.random.Generator) -> tuple[np.ndarray, list[list[int]], dict]:
    positions, quads = noisy_grid(rng)
    faces = quads
    if kind == "triangles":
        faces = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    elif kind == "several irregular vertices":
        faces = quads[rng.random(len(quads)) > 0.3]
    used, corners = np.unique(faces, return_inverse=True)
    faces = corners.reshape(faces.shape)
    options = {}
    if kind == "semi-sharp":
        edges = np.unique(
            np.sort(np.stack([faces, np.roll(faces, -1, 1)], 2).reshape(-1, 2)), axis=0
        )
        options["edge_sharpness"] = (edges, rng.uniform(0.5, 4, len(edges)))
    return positions[used], faces, options


@pytest.mark.parametrize(
    ("kind", "sharpness"),
    [("regular", None), ("several irregular vertices", 0), ("triangles", 0), ("semi-sharp", 4)],
)
@pytest.mark.parametrize("distance", [2.0**20, 2.0**30])
def test_what_large_coordinates_cost(kind, sharpness, distance):
    rng = np.random.default_rng(7)
    positions, faces, options = mesh(kind, rng)
    far = positions + distance * np.array([1, 0.9, 0.8])
    near = far - far[0]
    assert np.array_equal(near + far[0], far)
    away, here = (
        ls.LimitSurface(ls.ControlMesh.from_faces(points, faces, **options))
        for points in (far, near)
    )
    face, uv = rng.integers(0, here.face_count, 5_000), rng.random((5_000, 2))
    got, true = away.evaluate(face, uv, 2), here.evaluate(face, uv, 2)
    unit = ROUNDING * np.abs(far).max()
    if sharpness is None:
        first = second = 0.0
    else:
        first, second = FIRST_ERROR * unit, second_error(sharpness) * unit
    for name, bound in (
        ("du", first),
        ("dv", first),
        ("duu", second),
        ("duv", second),
        ("dvv", second),
    ):
        error = np.abs(getattr(got, name) - getattr(true, name)).max()
        assert error <= bound + 1e-12, name
    lengths = [np.linalg.norm(d, axis=1) for d in (true.du, true.dv)]
    across = np.linalg.norm(np.cross(true.du, true.dv), axis=1)
    condition = np.hypot(*lengths) * np.sqrt(2) * np.maximum(*lengths) / across
    turned = np.linalg.norm(got.normal - true.normal, axis=1)
    allowed = NORMAL_ERROR * unit * condition / np.maximum(*lengths) + 1e-11 * condition
    assert (turned <= allowed).all()


@pytest.mark.parametrize("distance", [2.0**16, 2.0**20, 2.0**26, 2.0**30])
@pytest.mark.parametrize("cut", [False, True])
def test_normals_of_far_meshes_are_right_or_nan(distance, cut):
    """A cube that is nearly collapsed onto a line: far away its tangents, which are nearly
    parallel, are as different as their rounding.
    """
    cube, quads = shapes.cube()
    unit = 2.0**-20
    line = np.round(np.outer(cube @ [1, 2, 0.5], [0.3, 0.7, 0.11]) / unit) * unit
    faces = shapes.halves(quads) if cut else quads
    near, far = (
        ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
        for positions in (line, line + distance)
    )
    rng = np.random.default_rng(0)
    at = rng.integers(0, near.face_count, 2000), rng.random((2000, 2))
    truth, normal = (surface.evaluate(*at, 1).normal for surface in (near, far))
    assert np.isfinite(truth).all()
    is_known = np.isfinite(normal[:, 0])
    assert is_known.any() == (distance < 2.0**20)
    assert np.linalg.norm(normal - truth, axis=1)[is_known].max(initial=0) < MOST_TURN
