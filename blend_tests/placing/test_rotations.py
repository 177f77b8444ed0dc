# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames in world space."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from limit_surface.errors import RefusalError
from limit_surface.placing.rotations import WorldSpace
from mathutils import Quaternion

unit_quaternions = (
    st.tuples(*[st.floats(-1, 1)] * 4)
    .map(lambda q: Quaternion(q))
    .filter(lambda q: q.magnitude > 1e-3)
    .map(lambda q: q.normalized())
)


def matrix(q):
    return np.array(q.to_matrix(), np.float64)


@given(unit_quaternions, st.tuples(*[st.floats(0.1, 10) | st.floats(-10, -0.1)] * 3))
def test_world_frames_are_orthonormal_and_map_back(q, scale):
    space = np.eye(4)
    space[:3, :3] = matrix(q) @ np.diag(scale)
    world = WorldSpace(space)
    frame = world.frames(np.eye(3)[None])
    np.testing.assert_allclose(frame[0].T @ frame[0], np.eye(3), atol=1e-9)
    assert np.linalg.det(frame[0]) == pytest.approx(np.sign(np.prod(scale)))
    vectors = np.array([[1.0, 2.0, 3.0]])
    np.testing.assert_allclose(world.to_local(vectors) @ space[:3, :3].T, vectors, atol=1e-9)


def test_a_singular_matrix_is_refused():
    with pytest.raises(RefusalError, match="has a scale of 0 along an axis"):
        WorldSpace(np.diag([1.0, 0.0, 1.0, 1.0]))
