# SPDX-License-Identifier: GPL-3.0-or-later
"""Scale, rotation, tilt and flow of instances that a source steers, as Blender shows them."""

import bpy
import numpy as np
import particle_scenes
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from scenes import add_points, add_subsurf
from sheet_sources import INNER, SIDE, SOURCES, add_image, of_attribute, of_group, rising, steered

TRANSFORMS = {
    "identity": {},
    "rotated": {"rotation_euler": (0.3, -1.1, 2.0), "location": (5, -3, 2)},
    "mirrored": {"scale": (-1.0, 1.0, 1.0), "rotation_euler": (0.1, 0.2, 0.3)},
    "stretched": {"scale": (0.5, 2.0, 3.0), "rotation_euler": (1.0, 0.2, 0.4)},
}


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def add_thorn():
    return scenes.add_mesh("Thorn", [(0, 0, 0), (0.1, 0, 0), (0, 0, 1)], [(0, 1, 2)])


def add_thorny(ob, **properties):
    """Adds points with an instance each. Returns the points, and their instances' matrices."""
    thorn = bpy.data.objects.get("Thorn") or add_thorn()
    points = add_points(ob, instance=thorn.name, **properties)
    return points, matrices(points)


def matrices(points):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    depsgraph.update()
    return np.array(
        [
            np.array(i.matrix_world)
            for i in depsgraph.object_instances
            if i.is_instance and i.parent.original == points
        ]
    )


def places(points):
    return attributes.read(points.data, "position").astype(np.float64)


def is_inner(root):
    """Tells which points are where the limit surface is the mesh itself."""
    inner = ((root[:, :2] > INNER) & (root[:, :2] < SIDE - INNER)).all(axis=1)
    assert inner.sum() > 400
    return inner


def about_z(angle):
    cosine, sine, zero = np.cos(angle), np.sin(angle), 0 * angle
    rows = [[cosine, -sine, zero], [sine, cosine, zero], [zero, zero, zero + 1]]
    return np.moveaxis(np.array(rows), 2, 0)


@pytest.mark.parametrize("source", SOURCES)
def test_scale_and_rotation_are_linear_between_the_ends_of_the_range(source):
    ob = scenes.flat_grid(SIDE)
    add_subsurf(ob).uv_smooth = "NONE"
    chosen = SOURCES[source](ob)
    points, shown = add_thorny(
        ob,
        scale=0.5,
        rotation=2.0,
        **steered("scale", chosen, 0.2, 1.2),
        **steered("rotation", chosen, -1, 1),
    )
    root = places(points)
    inner = is_inner(root)
    value = rising(root[inner])
    size = 0.5 * (0.2 + value)
    np.testing.assert_allclose(attributes.read(points.data, ids.SCALE)[inner], size, atol=1e-6)
    turned = about_z(2.0 * (2 * value - 1))
    np.testing.assert_allclose(shown[inner][:, :3, :3], size[:, None, None] * turned, atol=5e-6)
    np.testing.assert_allclose(shown[:, :3, 3], root, atol=1e-5)


def test_tilt_is_towards_the_axes_of_the_instance():
    ob = scenes.flat_grid(SIDE)
    chosen = of_group(ob)
    points, shown = add_thorny(
        ob, rotation=np.pi / 2, tilt=(0.8, 0), **steered("tilt", chosen, -1, 1)
    )
    root = places(points)
    inner = is_inner(root)
    angle = 0.8 * (2 * rising(root[inner]) - 1)
    z = shown[inner][:, :3, 2]
    # X has become the world's Y
    expected = np.stack([0 * angle, np.sin(angle), np.cos(angle)], axis=1)
    np.testing.assert_allclose(z, expected, atol=5e-6)
    # the axis about which it turns stays
    np.testing.assert_allclose(shown[inner][:, :3, 1], [[-1, 0, 0]] * len(z), atol=5e-6)
    np.testing.assert_allclose(np.linalg.det(shown[:, :3, :3]), 1, atol=1e-5)


@pytest.mark.parametrize("transform", TRANSFORMS)
@pytest.mark.parametrize("axis", ["X", "Z"])
def test_flow_by_a_vector_attribute(axis, transform):
    ob = scenes.flat_grid(4)
    scenes.place(ob, TRANSFORMS[transform])
    vector = np.array([0.6, -0.8, 5.0])  # what is along the normal does not count
    attributes.write(ob.data, "comb", "FLOAT_VECTOR", "POINT", np.tile(vector, (25, 1)))
    _, shown = add_thorny(
        ob, flow_source="ATTRIBUTE", flow_attribute="comb", flow_axis=axis, flow_angle=0.7
    )
    linear = np.array(ob.matrix_world)[:3, :3]
    # instances are posed in the object's space, and stretched with it
    local = np.linalg.solve(linear, shown[:, :3, :3])
    towards = vector * [1, 1, 0]
    if axis == "X":
        expected = np.stack([towards, [0.8, 0.6, 0], [0, 0, 1]], axis=1)
        np.testing.assert_allclose(local, np.broadcast_to(expected, local.shape), atol=2e-5)
    else:
        z = np.cos(0.7) * np.array([0, 0, 1]) + np.sin(0.7) * towards
        np.testing.assert_allclose(local[:, :, 2], np.broadcast_to(z, (len(local), 3)), atol=2e-5)


def test_rotation_is_added_to_the_flow():
    ob = scenes.flat_grid(4)
    attributes.write(ob.data, "comb", "FLOAT_VECTOR", "POINT", np.tile([0.0, 0.1, 0], (25, 1)))
    _, shown = add_thorny(ob, flow_source="ATTRIBUTE", flow_attribute="comb", rotation=0.3)
    turned = about_z(np.full(len(shown), np.pi / 2 + 0.3))
    np.testing.assert_allclose(shown[:, :3, :3], turned, atol=5e-6)


def test_where_there_is_no_flow_the_axes_are_those_of_the_surface():
    ob = scenes.flat_grid(4)
    _, without = add_thorny(ob)
    attributes.write(ob.data, "comb", "FLOAT_VECTOR", "POINT", np.zeros((25, 3)))
    _, shown = add_thorny(ob, flow_source="ATTRIBUTE", flow_attribute="comb")
    np.testing.assert_allclose(shown, without, atol=1e-6)


@pytest.mark.slow
def test_flow_by_curves_and_on_a_curved_surface():
    ob = scenes.monkey()
    add_subsurf(ob)
    curve = bpy.data.curves.new("Parting", "CURVE")
    curve.dimensions = "3D"
    spline = curve.splines.new("POLY")
    spline.points.add(3)
    lines = np.array([(0.1 * z, -0.9, z) for z in (1.2, 0.9, 0.6, 0.3)])
    for point, place in zip(spline.points, lines.tolist(), strict=True):
        point.co = (*place, 1)
    parting = bpy.data.objects.new("Parting", curve)
    bpy.context.collection.objects.link(parting)
    points, shown = add_thorny(ob, per_side=1, flow_source="CURVES", flow_curves="Parting")
    surface = scenes.surface_without_addon(ob)
    face, uv = scenes.locations(points.data)
    flow = surface.curve_directions(lines, [0, 4], face, uv)
    normal = surface.frames(face, uv)[:, :, 2]
    strong = np.linalg.norm(flow, axis=1) > 0.1
    assert strong.sum() > 100
    np.testing.assert_allclose(shown[strong][:, :3, 0], unit(flow[strong]), atol=2e-4)
    np.testing.assert_allclose(shown[:, :3, 2], normal, atol=1e-5)


def test_random_parts_stay_within_their_bounds_and_grow_with_their_source():
    ob = scenes.flat_grid(SIDE)
    chosen = of_group(ob)
    free = {"random": 0.6, "random_scale": 0.5, "random_rotation": 0.4, "seed": 3}
    points, whole = add_thorny(ob, **free)
    _, part = add_thorny(ob, **free, **steered("random", chosen, 0, 1))
    _, other = add_thorny(ob, **free | {"seed": 4})
    root = places(points)
    inner = is_inner(root)
    value = rising(root[inner])
    sizes, leans = [], []
    for shown in (whole, part):
        size = np.cbrt(np.linalg.det(shown[:, :3, :3]))
        z = shown[:, :3, 2] / size[:, None]
        sizes.append(size[inner])
        leans.append(np.arctan2(np.linalg.norm(z[:, :2], axis=1), z[:, 2])[inner])
    assert 0.5 <= sizes[0].min() < 0.52
    assert 0.98 < sizes[0].max() <= 1 + 1e-6
    assert 0.57 < leans[0].max() <= 0.6 + 1e-5
    np.testing.assert_allclose(1 - sizes[1], value * (1 - sizes[0]), atol=1e-5)
    np.testing.assert_allclose(leans[1], value * leans[0], atol=1e-4)
    assert np.abs(other[:, :3, :3] - whole[:, :3, :3]).max() > 0.1

    _, turned = add_thorny(ob, random_rotation=0.4)
    angle = np.arctan2(turned[inner, 1, 0], turned[inner, 0, 0])
    assert -0.4 <= angle.min() < -0.38
    assert 0.38 < angle.max() <= 0.4 + 1e-6
    assert abs(angle.mean()) < 0.03


def test_scales_of_fish_are_posed_as_well():
    ob = scenes.flat_grid(2)
    plain, posed = (
        matrices(add_points(ob, instances="SCALE", **pose))[:, :3, :3]
        for pose in ({}, {"scale": 0.5, "rotation": 0.3})
    )
    np.testing.assert_allclose(posed, 0.5 * plain @ about_z(np.array([0.3])), atol=1e-5)


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_points_that_follow_keep_scale_and_turn(follow):
    ob = scenes.cross()
    add_subsurf(ob)
    key = particle_scenes.add_shape_key(ob)
    points, before = add_thorny(
        ob, follow=follow, scale=0.5, rotation=1.0, tilt=(0.4, 0.2), random_scale=0.5
    )
    face, uv = scenes.locations(points.data)
    rest = scenes.surface_without_addon(ob).frames(face, uv)
    key.value = 1
    now = scenes.surface_without_addon(ob).frames(face, uv)
    turn = now @ np.swapaxes(rest, 1, 2)
    assert np.abs(turn - np.eye(3)).max() > 0.1
    np.testing.assert_allclose(matrices(points)[:, :3, :3], turn @ before[:, :3, :3], atol=1e-5)


def test_along_a_border():
    ob = scenes.flat_grid(4)
    _, shown = add_thorny(
        ob, distribution="BORDER", count=64, direction="OUTWARDS", rotation=0.5, scale=2
    )
    _, plain = add_thorny(ob, distribution="BORDER", count=64, direction="OUTWARDS")
    np.testing.assert_allclose(
        shown[:, :3, :3], 2 * plain[:, :3, :3] @ about_z(np.array([0.5])), atol=1e-5
    )


REFUSED = {
    "no vertex group 'Nix'": {"source": "VERTEX_GROUP", "vertex_group": "Nix"},
    "no image 'Nix'": {"source": "IMAGE", "image": "Nix"},
    "no attribute 'Nix'": {"source": "ATTRIBUTE", "attribute": "Nix"},
    "The image Ramp cannot be placed: Flat has no UV map": {"source": "IMAGE", "image": "Ramp"},
}


@pytest.mark.parametrize("prefix", ["scale", "rotation", "tilt", "random"])
@pytest.mark.parametrize("match", REFUSED)
def test_sources_that_cannot_be_used(match, prefix):
    scenes.flat_grid(2)
    add_image("Ramp", np.ones((2, 2)))
    before, active = scenes.file_contents(), bpy.context.active_object
    with pytest.raises(RuntimeError, match=f"{prefix.capitalize()}: .*{match}"):
        bpy.ops.object.limit_points_add(**steered(prefix, REFUSED[match], 0, 1))
    assert scenes.file_contents() == before
    assert bpy.context.active_object == active


def test_an_attribute_of_whole_numbers_is_a_factor():
    ob = scenes.flat_grid(2)
    attributes.write(ob.data, "size", "INT", "FACE", np.arange(4))
    source = {"source": "ATTRIBUTE", "attribute": "size"}
    points, _ = add_thorny(ob, **steered("scale", source, 0, 1))
    face, _uv = scenes.locations(points.data)
    np.testing.assert_allclose(attributes.read(points.data, ids.SCALE), face)


def test_sizes_never_fall_below_0():
    ob = scenes.flat_grid(SIDE)
    points, _ = add_thorny(ob, **steered("scale", of_attribute(ob), -1, 1))
    root = places(points)
    inner = is_inner(root)
    expected = np.maximum(2 * rising(root[inner]) - 1, 0)
    np.testing.assert_allclose(attributes.read(points.data, ids.SCALE)[inner], expected, atol=1e-6)
