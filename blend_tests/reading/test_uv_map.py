# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners that share one UV value."""

import numpy as np
import pytest
import scenes
from hypothesis import given
from hypothesis import strategies as st
from limit_surface import ids
from limit_surface.reading import attributes, uv_map


def leaders(vertex, uv, mirrored):
    """Returns for each corner the one whose value it takes, found vertex by vertex."""
    found = list(range(len(vertex)))
    for v in set(vertex):
        rest = [c for c in range(len(vertex)) if vertex[c] == v]
        while rest:
            leader = rest[-1]
            for c in rest:
                close = (np.abs(uv[c] - uv[leader]) < np.float32(1e-4)).all()
                if close and mirrored[c] == mirrored[leader]:
                    found[c] = leader
            rest = [c for c in rest if found[c] != leader]
    return found


FAN = [(0, 1, 2), (0, 2, 3, 4), (0, 4, 5), (0, 5, 6, 7, 8), (0, 8, 1)]


@pytest.fixture
def fan():
    angle = 2 * np.pi * np.arange(8) / 8
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    ob = scenes.add_mesh("Fan", np.concatenate([[(0, 0, 0)], ring]), FAN)
    ob.data.uv_layers.new(name="Map")
    return ob


def read(ob, uv):
    ob.data.uv_layers["Map"].data.foreach_set("uv", uv.astype(np.float32).ravel())
    found = uv_map.read(ob.data, "Map")
    assert found.name == "Map"
    assert found.values.dtype == np.float64
    return found


def from_vertices(ob):
    corner_vertex = attributes.read(ob.data, ids.CORNER_VERTEX)
    return attributes.read(ob.data, "position")[corner_vertex][:, :2].copy()


def test_a_map_without_seams_has_one_value_at_each_vertex(fan):
    uv = from_vertices(fan)
    found = read(fan, uv)
    assert len(found.values) == 9
    np.testing.assert_array_equal(found.values[found.indices], uv)


@pytest.mark.parametrize(("shift", "count"), [(0.9e-4, 9), (1.1e-4, 10), (-0.9e-4, 9), (0.3, 10)])
@pytest.mark.parametrize("axis", [0, 1])
def test_corners_closer_than_blenders_limit_are_one(fan, shift, count, axis):
    uv = from_vertices(fan)
    uv[3, axis] += shift  # the second face's corner at vertex 0, which is at (0, 0)
    found = read(fan, uv)
    assert len(found.values) == count
    if count == 9:  # all corners take the last corner's value
        np.testing.assert_array_equal(found.values[found.indices[3]], (0, 0))


def test_faces_that_are_mirrored_on_the_map_share_nothing_with_others(fan):
    """This is so after a Mirror modifier, whose halves lie on each other."""
    uv = from_vertices(fan)
    uv[3:7] = uv[3:7] * [-1, 1]  # the second face
    found = read(fan, uv)
    at_centre = found.indices[[0, 3, 7, 10, 15]]  # all at (0, 0)
    assert len(set(at_centre)) == 2
    assert at_centre[1] not in at_centre[[0, 2, 3, 4]]


def test_corners_of_different_vertices_share_nothing(fan):
    found = read(fan, np.zeros((18, 2)))
    assert len(found.values) == 9


@given(
    st.lists(st.tuples(*[st.integers(-2, 2)] * 2), min_size=18, max_size=18),
    st.lists(st.booleans(), min_size=5, max_size=5),
)
def test_as_told_vertex_by_vertex(steps, mirrored):
    """The shifts are close to the limit, where the result depends on the order of the corners."""
    vertex = np.concatenate(FAN)
    uv = (np.array(steps) * 0.6e-4 + 0.5).astype(np.float32)
    mirrored = np.repeat(mirrored, [len(face) for face in FAN])
    found = uv_map._leaders(uv, vertex, mirrored)
    assert found.tolist() == leaders(vertex.tolist(), uv, mirrored)


def test_no_area_on_the_map_is_not_mirrored():
    flat = np.zeros((3, 2), np.float32)
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
    uv = np.concatenate([flat, square, square[::-1]])
    assert uv_map._is_mirrored(uv, np.array([3, 4, 4])).tolist() == [False, False, True]
