# SPDX-License-Identifier: GPL-3.0-or-later
"""Direction and length of strands in world space."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.reading import attributes
from scenes import (
    add_hair,
    add_subsurf,
    locations,
    place,
    strands,
    surface_without_addon,
    transformed,
)

TRANSFORMS = {
    "identity": {},
    "rotated": {"rotation_euler": (0.3, -1.1, 2.0), "location": (5, -3, 2)},
    "stretched": {"scale": (0.5, 2.0, 3.0), "rotation_euler": (1.0, 0.2, 0.4)},
    "mirrored": {"scale": (-1.0, 1.0, 1.0), "rotation_euler": (0.1, 0.2, 0.3)},
    "mirrored and stretched": {"scale": (2.0, -0.3, 1.5), "location": (1, 2, 3)},
    "turned inside out": {"scale": (-1.2, -0.7, -2.0)},
}


def world_vectors(hair):
    """Returns the vector from root to tip of each strand in the world, by Blender's own matrix."""
    points = transformed(hair.matrix_world, strands(hair).astype(np.float64))
    return points[:, -1] - points[:, 0]


def world_axes(ob, hair):
    """Returns the unit tangents along u and v and the normal, in the world, from the surface's
    derivatives.
    """
    linear = np.array(ob.matrix_world)[:3, :3]
    s = surface_without_addon(ob).evaluate(*locations(hair.data), derivatives=1)
    du, dv = s.du @ linear.T, s.dv @ linear.T
    outward = np.cross(du, dv) * np.sign(np.linalg.det(linear))
    return tuple(v / np.linalg.norm(v, axis=1, keepdims=True) for v in (du, dv, outward))


@pytest.mark.parametrize("transform", TRANSFORMS)
@pytest.mark.parametrize("scene", ["cross", "mixed polygons"])
def test_straight_along_the_world_normal_in_world_units(scene, transform):
    ob = scenes.SCENES[scene]()
    add_subsurf(ob)
    place(ob, TRANSFORMS[transform])
    hair = add_hair(ob, length=0.37)
    assert hair.matrix_world == ob.matrix_world
    np.testing.assert_allclose(
        world_vectors(hair), 0.37 * world_axes(ob, hair)[2], atol=1e-5 * max(ob.scale.length, 1)
    )


def test_transform_through_sheared_parents():
    ob, parent = scenes.cross(), bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale, ob.rotation_euler, ob.parent = (1, 3, 0.5), (0.4, 0.5, 0.6), parent
    bpy.context.view_layer.update()
    hair = add_hair(ob, length=0.2)
    assert hair.matrix_world == ob.matrix_world
    np.testing.assert_allclose(world_vectors(hair), 0.2 * world_axes(ob, hair)[2], atol=1e-5)


def test_hair_moves_with_its_surface():
    ob = scenes.cross()
    hair = add_hair(ob)
    assert hair.parent == hair.data.surface == ob
    ob.location, ob.scale = (1, 2, 3), (2, 1, -1)
    bpy.context.view_layer.update()
    assert hair.matrix_world == ob.matrix_world


def test_points_are_evenly_spaced():
    hair = add_hair(scenes.cross(), points=9)
    points = strands(hair)
    assert points.shape[1] == 9
    steps = np.diff(points, axis=1)
    np.testing.assert_allclose(steps, np.broadcast_to(steps[:, :1], steps.shape), atol=1e-6)


@pytest.mark.parametrize("transform", ["identity", "stretched", "mirrored"])
@pytest.mark.parametrize("tilt", [(0.4, 0.0), (0.0, 0.4), (-0.3, 0.5)])
def test_tilt_leans_towards_u_and_v(tilt, transform):
    ob = scenes.grid_with_holes()
    place(ob, TRANSFORMS[transform])
    hair = add_hair(ob, tilt=tilt, length=1)
    direction = world_vectors(hair)
    u, v, normal = world_axes(ob, hair)
    across = v - np.sum(v * u, axis=1, keepdims=True) * u
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angle = np.hypot(*tilt)
    expected = [np.sin(angle) / angle * tilt[0], np.sin(angle) / angle * tilt[1], np.cos(angle)]
    found = [np.sum(direction * axis, axis=1) for axis in (u, across, normal)]
    np.testing.assert_allclose(found, np.broadcast_to(np.c_[expected], np.shape(found)), atol=2e-5)


def test_random_stays_within_its_angle_and_keeps_the_length():
    ob = scenes.cross()
    hair = add_hair(ob, random=0.5, length=1, per_side=20)
    direction = world_vectors(hair)
    angle = np.arccos(np.clip(np.sum(direction * world_axes(ob, hair)[2], axis=1), -1, 1))
    assert angle.max() <= 0.5 + 1e-4
    assert angle.max() > 0.48
    # the mean distance from the centre, uniform in a disc, is two thirds of the radius
    assert 0.3 < angle.mean() < 0.37
    np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1, atol=1e-5)


def test_seed_decides():
    ob = scenes.cross()
    same, again, other = (
        strands(add_hair(ob, random=0.5, seed=seed, per_side=3)) for seed in (7, 7, 8)
    )
    np.testing.assert_array_equal(same, again)
    assert np.abs(same - other).max() > 0.01


def test_radius_is_in_world_units():
    ob = scenes.cross()
    place(ob, {"scale": (2, 2, -2)})
    hair = add_hair(ob, radius=0.03)
    np.testing.assert_allclose(attributes.read(hair.data, "radius"), 0.015, rtol=1e-6)


def test_a_flattened_object_is_refused():
    ob = scenes.cross()
    place(ob, {"scale": (1, 1, 0)})
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="has a scale of 0 along an axis"):
        bpy.ops.object.limit_hair_add()
    assert scenes.file_contents() == before
