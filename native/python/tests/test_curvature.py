# SPDX-License-Identifier: Apache-2.0
import limitsurf as ls
import numpy as np
import shapes


def dot(a, b):
    return np.einsum("ni,ni->n", a, b)


def test_is_how_the_normal_turns(surface):
    """By differences of the normal along the principal directions: dn = -k ds."""
    rng = np.random.default_rng(0)
    n = 200
    face = rng.integers(0, surface.face_count, n)
    uv = rng.uniform(0.2, 0.8, (n, 2))
    here, curvature = surface.evaluate(face, uv, 1), surface.curvature(face, uv)
    tangents = np.stack([here.du, here.dv], axis=2)
    sound = np.linalg.norm(np.cross(here.du, here.dv), axis=1) > 0.05
    h = 1e-5
    for k, direction in (
        (curvature.k1, curvature.direction1),
        (curvature.k2, curvature.direction2),
    ):
        step = np.einsum("nij,nj->ni", np.linalg.pinv(tangents), direction)
        after = surface.evaluate(face, np.clip(uv + h * step, 0, 1), 1).normal
        before = surface.evaluate(face, np.clip(uv - h * step, 0, 1), 1).normal
        turned = (after - before) / (2 * h)
        inside = (np.abs(h * step) < 0.1).all(axis=1) & sound
        expected = -k[:, None] * direction
        error = np.linalg.norm(turned - expected, axis=1)[inside]
        assert error.max() < 1e-5 * max(1, np.abs(k[inside]).max()) ** 3


def test_fields_belong_together(surface, anywhere):
    face, uv = anywhere(surface, 100)
    c = surface.curvature(face, uv)
    assert (c.k1 >= c.k2).all()
    scale = np.abs(c.k1) + np.abs(c.k2) + 1e-300
    assert (np.abs(c.mean - (c.k1 + c.k2) / 2) <= 1e-12 * scale).all()
    assert (np.abs(c.gaussian - c.k1 * c.k2) <= 1e-12 * scale**2).all()
    normal = surface.evaluate(face, uv, 1).normal
    for direction in (c.direction1, c.direction2):
        assert direction.shape == (100, 3)
        np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1, atol=1e-12)
        np.testing.assert_allclose(dot(direction, normal), 0, atol=1e-9)
    np.testing.assert_allclose(dot(c.direction1, c.direction2), 0, atol=1e-9)


def test_of_something_like_a_sphere_is_that_of_its_radius():
    """A finely refined sphere's cage has a limit surface close to a sphere."""
    positions, faces = shapes.cube()
    for _ in range(4):
        surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
        finer = surface.tessellate(1)
        positions, faces = finer.positions, finer.faces
        positions = positions - positions.mean(axis=0)
        positions /= np.linalg.norm(positions, axis=1, keepdims=True)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    rng = np.random.default_rng(0)
    face, uv = rng.integers(0, surface.face_count, 500), rng.uniform(0.1, 0.9, (500, 2))
    radius = np.linalg.norm(surface.evaluate(face, uv).position, axis=1)
    c = surface.curvature(face, uv)
    assert np.median(np.abs(c.mean * radius + 1)) < 0.02
    assert np.median(np.abs(c.gaussian * radius**2 - 1)) < 0.02
    assert (c.k1 < 0).all()


def test_is_missing_at_irregular_vertices_alone(cube):
    at = cube.curvature(np.arange(6), np.zeros((6, 2)))
    assert np.isnan(at.mean).all()
    near = cube.curvature(np.arange(6), np.full((6, 2), 2.0**-30))
    assert np.isfinite(near.mean).all()
    flat = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(4, 4)))
    np.testing.assert_allclose(flat.curvature(5, [[0, 0], [1, 1], [0.5, 1]]).k1, 0, atol=1e-14)
