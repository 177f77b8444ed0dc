# SPDX-License-Identifier: Apache-2.0
import limitsurf as ls
import numpy as np
import pytest
import shapes

CORNERS = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)


def everywhere(surface):
    """Random places, and places near and at every corner of every face."""
    rng = np.random.default_rng(0)
    face, uv = [], []
    for f in range(surface.face_count):
        places = [rng.random((5, 2)), CORNERS]
        places += [np.abs(CORNERS - 2.0**-n) for n in (3, 20, 40)]
        places += [np.abs(CORNERS - [2.0**-n, 0]) for n in (3, 20, 40)]
        uv.append(np.concatenate(places))
        face += [f] * len(uv[-1])
    return np.array(face), np.concatenate(uv)


def test_are_rotations_everywhere(surface):
    frames = surface.frames(*everywhere(surface))
    identity = np.broadcast_to(np.eye(3), frames.shape)
    np.testing.assert_allclose(frames.transpose(0, 2, 1) @ frames, identity, atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(frames), 1, atol=1e-14)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_placed_frames_are_positions_and_frames_to_the_bit(surface, dtype):
    at = everywhere(surface)
    placed = surface.placed_frames(*at, dtype=dtype)
    np.testing.assert_array_equal(placed.frame, surface.frames(*at, dtype=dtype))
    np.testing.assert_array_equal(placed.position, surface.evaluate(*at, dtype=dtype).position)
    assert placed.frame.dtype == placed.position.dtype == dtype


def test_columns_are_tangent_binormal_normal(surface, anywhere):
    face, uv = anywhere(surface, 100)
    here, frames = surface.evaluate(face, uv, 1), surface.frames(face, uv)
    tangent = here.du / np.linalg.norm(here.du, axis=1, keepdims=True)
    np.testing.assert_allclose(frames[:, :, 0], tangent, atol=1e-14)
    np.testing.assert_allclose(frames[:, :, 1], np.cross(here.normal, tangent), atol=1e-14)
    np.testing.assert_allclose(frames[:, :, 2], here.normal, atol=1e-14)


@pytest.mark.parametrize("count", [3, 4, 5, 6, 8])
def test_at_an_interior_vertex_are_the_limit_of_the_diagonal(count):
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.fan(count, True)))
    at = surface.frames(np.arange(count), np.zeros((count, 2)))
    errors = []
    for n in (20, 30, 40):
        near = surface.frames(np.arange(count), np.full((count, 2), 2.0**-n))
        errors.append(np.abs(near - at).max())
    # The rest shrinks geometrically, by less than a fifth a level.
    assert errors[2] < 1e-4
    assert errors[1] < 0.9 * errors[0] or errors[1] < 1e-12
    assert errors[2] < 0.9 * errors[1] or errors[2] < 1e-12


def test_at_a_vertex_of_two_faces_are_the_mean_of_even_and_odd_levels():
    """There the derivatives at u = v = 2^-n shrink by a half with each n, and a part of them has
    another sign at every n: the frame is that of the rest.
    """
    positions = np.random.default_rng(2).normal(size=(5, 3))
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, [[0, 1, 3, 2], [0, 2, 4, 1]]))
    n = np.array([30, 31])
    near = surface.evaluate([0, 0], 2.0 ** -n[:, None] * [1, 1], 1)
    du, dv = (2.0 ** n[:, None] * derivative for derivative in (near.du, near.dv))
    at = surface.frames(0, [[0.0, 0.0]])[0]
    tangent, normal = du.sum(axis=0), np.cross(du, dv).sum(axis=0)
    np.testing.assert_allclose(at[:, 2], normal / np.linalg.norm(normal), atol=1e-6)
    tangent = tangent - (tangent @ at[:, 2]) * at[:, 2]
    np.testing.assert_allclose(at[:, 0], tangent / np.linalg.norm(tangent), atol=1e-6)
    turned = np.cross(du[0], dv[0])
    assert np.abs(at[:, 2] - turned / np.linalg.norm(turned)).max() > 0.1, "no limit"


def test_at_a_regular_boundary_are_those_of_the_patch():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.fan(2, False)))
    here = surface.evaluate([0, 1], np.zeros((2, 2)), 1)
    frames = surface.frames([0, 1], np.zeros((2, 2)))
    np.testing.assert_allclose(frames[:, :, 2], here.normal, atol=1e-14)


def test_at_all_faces_of_a_vertex_share_the_normal():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.fan(7, True)))
    normals = surface.frames(np.arange(7), np.zeros((7, 2)))[:, :, 2]
    np.testing.assert_allclose(normals, normals[[0] * 7], atol=1e-13)
    evaluated = surface.evaluate(np.arange(7), np.zeros((7, 2)), 1).normal
    np.testing.assert_allclose(evaluated, normals, atol=1e-13)


def test_normals_point_outwards(cube, anywhere):
    face, uv = anywhere(cube, 200)
    here = cube.evaluate(face, uv, 1)
    assert (np.einsum("ni,ni->n", here.normal, here.position - 0.5) > 0).all()
