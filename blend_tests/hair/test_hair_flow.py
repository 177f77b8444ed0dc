# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands that lean into a flow: flow maps, vector attributes and principal directions."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from scenes import add_hair, add_subsurf, add_uv_map, place, strands, transformed

SIDE = 8
ANGLE = 0.7
# the scales are even along x and y, so that the flat sheet keeps its angles
TRANSFORMS = {
    "identity": {},
    "rotated": {"rotation_euler": (0.3, -1.1, 2.0), "location": (5, -3, 2)},
    "mirrored": {"scale": (-1.0, 1.0, 1.0), "rotation_euler": (0.1, 0.2, 0.3)},
    "turned inside out": {"scale": (-2.0, -2.0, -0.5)},
}


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def world_directions(hair):
    """Returns unit vectors from root to tip in the world, and the roots in the object's space."""
    points = strands(hair).astype(np.float64)
    in_world = transformed(hair.matrix_world, points)
    return unit(in_world[:, -1] - in_world[:, 0]), points[:, 0]


def is_inner(root):
    """Tells which roots are where the limit surface is the mesh itself, parameters included."""
    inner = ((root[:, :2] > 1) & (root[:, :2] < SIDE - 1)).all(axis=1)
    assert inner.sum() > 400
    return inner


def leaning(ob, towards, angle):
    """Returns the unit vectors in the world between a flat sheet's normal and directions on it."""
    linear = np.array(ob.matrix_world)[:3, :3]
    normal = unit(np.linalg.inv(linear)[2])
    return np.cos(angle) * normal + np.sin(angle) * unit(towards @ linear.T)


def add_flow_map(name, x, y, size=4):
    pixels = np.ones((size, size, 4), np.float32)
    pixels[:, :, :2] = 0.5 + 0.5 * np.array([x, y])
    pixels[:, :, 2] = 0.9  # blue means nothing
    bpy.data.images.new(name, size, size, float_buffer=True).pixels.foreach_set(pixels.ravel())


@pytest.mark.parametrize("transform", TRANSFORMS)
@pytest.mark.parametrize("turned", [False, True])
def test_flow_maps_are_in_the_tangent_space_of_the_uv_map(turned, transform):
    """Red is along growing U, and green along growing V, also where the map is mirrored."""
    ob = scenes.flat_grid(SIDE)
    place(ob, TRANSFORMS[transform])
    along_u, along_v = ([0, 1, 0], [1, 0, 0]) if turned else ([1, 0, 0], [0, 1, 0])
    add_uv_map(ob, lambda p: p @ np.stack([along_u, along_v], axis=1) / SIDE)
    add_flow_map("Comb", 0.6, -0.8)
    hair = add_hair(ob, flow_source="IMAGE", flow_image="Comb", flow_angle=ANGLE)
    direction, root = world_directions(hair)
    direction = direction[is_inner(root)]
    towards = 0.6 * np.array(along_u) - 0.8 * np.array(along_v)
    expected = np.broadcast_to(leaning(ob, towards, ANGLE), direction.shape)
    np.testing.assert_allclose(direction, expected, atol=3e-5)


@pytest.mark.parametrize(("x", "y", "part"), [(0, 0, 0), (0.3, 0.4, 0.5), (0, 1, 1), (1, 1, 1)])
def test_strands_lean_by_the_length_in_the_flow_map(x, y, part):
    ob = scenes.flat_grid(2)
    add_uv_map(ob, lambda p: p[:, :2] / 2)
    add_flow_map("Comb", x, y)
    hair = add_hair(ob, flow_source="IMAGE", flow_image="Comb", flow_angle=ANGLE)
    direction, _ = world_directions(hair)
    np.testing.assert_allclose(direction[:, 2], np.cos(part * ANGLE), atol=2e-5)


def test_flow_maps_change_linearly_between_pixels():
    ob = scenes.flat_grid(SIDE)
    add_subsurf(ob).uv_smooth = "NONE"
    add_uv_map(ob, lambda p: p[:, :2] / SIDE)
    size = 32
    turn = (np.arange(size) + 0.5) / size * 2
    pixels = np.ones((2, size, 4), np.float32)
    pixels[:, :, :2] = 0.5 + 0.5 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    bpy.data.images.new("Comb", size, 2, float_buffer=True).pixels.foreach_set(pixels.ravel())
    hair = add_hair(ob, flow_source="IMAGE", flow_image="Comb", flow_angle=np.pi / 2)
    direction, root = world_directions(hair)
    inner = is_inner(root)
    turn = root[inner, 0] / SIDE * 2
    expected = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    # a chord of this arc is off the circle by its sagitta
    np.testing.assert_allclose(direction[inner, :2], expected, atol=(2 / size) ** 2 / 8 + 1e-4)


@pytest.mark.parametrize("transform", [*TRANSFORMS, "stretched"])
@pytest.mark.parametrize("domain", ["POINT", "CORNER", "FACE"])
def test_vector_attributes_are_in_the_space_of_the_object(domain, transform):
    ob = scenes.flat_grid(4)
    stretched = {"scale": (0.5, 2.0, 3.0), "rotation_euler": (1.0, 0.2, 0.4)}
    place(ob, {**TRANSFORMS, "stretched": stretched}[transform])
    count = {"POINT": 25, "CORNER": 64, "FACE": 16}[domain]
    vector = np.array([0.3, 0.4, 5.0])  # what is along the normal does not count
    attributes.write(ob.data, "comb", "FLOAT_VECTOR", domain, np.tile(vector, (count, 1)))
    hair = add_hair(ob, flow_source="ATTRIBUTE", flow_attribute="comb", flow_angle=ANGLE)
    direction, _ = world_directions(hair)
    expected = leaning(ob, vector * [1, 1, 0], 0.5 * ANGLE)
    np.testing.assert_allclose(direction, np.broadcast_to(expected, direction.shape), atol=3e-5)


def test_vectors_of_vertices_change_smoothly():
    """A field that is linear over the sheet is itself on the limit surface."""
    ob = scenes.flat_grid(SIDE)
    positions = attributes.read(ob.data, "position")
    field = np.stack([positions[:, 1] - 4, 4 - positions[:, 0], 0 * positions[:, 0]], axis=1) / 8
    attributes.write(ob.data, "comb", "FLOAT_VECTOR", "POINT", field)
    hair = add_hair(ob, flow_source="ATTRIBUTE", flow_attribute="comb", flow_angle=1)
    direction, root = world_directions(hair)
    inner = is_inner(root)
    x, y = root[inner, :2].T
    part = np.hypot(x - 4, y - 4) / 8
    np.testing.assert_allclose(direction[inner, 2], np.cos(part), atol=1e-5)
    sideways = np.stack([y - 4, 4 - x], axis=1) / 8 * np.sinc(part / np.pi)[:, None]
    np.testing.assert_allclose(direction[inner, :2], sideways, atol=1e-5)


def cylinder(ends):
    """Adds an upright cylinder that becomes round, as subdivision does it, with open ends."""
    turn, height = np.meshgrid(np.arange(12) * np.pi / 6, np.arange(5), indexing="ij")
    positions = np.stack([np.cos(turn), np.sin(turn), height], axis=-1).reshape(-1, 3)
    faces = [
        (5 * i + j, 5 * ((i + 1) % 12) + j, 5 * ((i + 1) % 12) + j + 1, 5 * i + j + 1)
        for i in range(12)
        for j in range(4)
    ]
    return scenes.add_mesh("Cylinder", positions[:, ends], faces)


@pytest.mark.parametrize("source", ["CURVATURE_1", "CURVATURE_2"])
@pytest.mark.parametrize("ends", [[0, 1, 2], [2, 0, 1], [1, 2, 0]])
def test_principal_directions_of_a_cylinder(source, ends):
    """The larger curvature, 0, runs along the axis; the other one, negative, around it. All strands
    lean to the same end of the axis: the lower one, if one is lower.
    """
    ob = cylinder(ends)
    hair = add_hair(ob, flow_source=source, flow_angle=np.pi / 2)
    direction, root = world_directions(hair)
    axis = np.zeros(3)
    axis[ends.index(2)] = 1
    outward = root * (1 - axis)
    around = unit(np.cross(axis, outward))
    if source == "CURVATURE_1":
        end = -1 if axis[2] else 1
        expected = np.broadcast_to(end * axis, direction.shape)
        np.testing.assert_allclose(direction, expected, atol=2e-4)
    else:
        along = np.abs(np.einsum("ni,ni->n", direction, around))
        assert along.min() > 0.99  # the surface is round but for some per cent
        np.testing.assert_allclose(direction @ axis, 0, atol=2e-4)
        level = np.abs(around[:, 2]) > 0.1
        assert (direction[level, 2] < 0).all()


def test_flat_surfaces_have_no_principal_directions():
    hair = add_hair(scenes.flat_grid(4), flow_source="CURVATURE_1")
    direction, _ = world_directions(hair)
    np.testing.assert_allclose(direction[:, 2], 1, atol=1e-6)


def test_tilt_is_added_to_the_flow_and_a_negative_angle_reverses_it():
    ob = scenes.flat_grid(SIDE)
    vectors = np.tile([0.0, 1.0, 0.0], ((SIDE + 1) ** 2, 1))
    attributes.write(ob.data, "comb", "FLOAT_VECTOR", "POINT", vectors)
    flow = {"flow_source": "ATTRIBUTE", "flow_attribute": "comb", "flow_angle": -0.4}
    direction, root = world_directions(add_hair(ob, tilt=(0.3, 0), **flow))
    direction = direction[is_inner(root)]
    lean = np.array([0.3, -0.4])
    expected = [*(lean * np.sin(0.5) / 0.5), np.cos(0.5)]
    np.testing.assert_allclose(direction, np.broadcast_to(expected, direction.shape), atol=1e-5)


REFUSED = {
    "Choose an image": {"flow_source": "IMAGE"},
    "Choose an attribute of Flat": {"flow_source": "ATTRIBUTE"},
    "no image 'Nix'": {"flow_source": "IMAGE", "flow_image": "Nix"},
    "The image Comb cannot be placed: Flat has no UV map": {
        "flow_source": "IMAGE",
        "flow_image": "Comb",
    },
    "Flat has no attribute 'Nix'": {"flow_source": "ATTRIBUTE", "flow_attribute": "Nix"},
    "The attribute number is FLOAT on POINT: vectors": {
        "flow_source": "ATTRIBUTE",
        "flow_attribute": "number",
    },
    "The attribute edges is FLOAT_VECTOR on EDGE": {
        "flow_source": "ATTRIBUTE",
        "flow_attribute": "edges",
    },
    "The attribute hole has values that are not finite": {
        "flow_source": "ATTRIBUTE",
        "flow_attribute": "hole",
    },
}


@pytest.mark.parametrize("match", REFUSED)
def test_flows_that_cannot_be_used(match):
    ob = scenes.flat_grid(2)
    add_flow_map("Comb", 1, 0)
    attributes.write(ob.data, "number", "FLOAT", "POINT", np.ones(9))
    attributes.write(ob.data, "edges", "FLOAT_VECTOR", "EDGE", np.ones((12, 3)))
    attributes.write(ob.data, "hole", "FLOAT_VECTOR", "POINT", np.full((9, 3), np.inf))
    check_hair_refused(f"Flow: .*{match}", REFUSED[match])


def test_a_flow_map_without_pixels(tmp_path):
    add_uv_map(scenes.flat_grid(2), lambda p: p[:, :2])
    missing = bpy.data.images.new("Gone", 4, 4)
    missing.source, missing.filepath = "FILE", str(tmp_path / "gone.png")
    refused = {"flow_source": "IMAGE", "flow_image": "Gone"}
    check_hair_refused("Flow: The image Gone has no pixels", refused)


def check_hair_refused(match, properties):
    before, active = scenes.file_contents(), bpy.context.active_object
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_hair_add(**properties)
    assert scenes.file_contents() == before
    assert bpy.context.active_object == active
    assert ids.REST_ROOT not in active.data.attributes


def add_curve(points, cyclic=False, bevel=0.0):
    """Adds a curve of straight lines."""
    data = bpy.data.curves.new("Guide", "CURVE")
    data.dimensions, data.bevel_depth = "3D", bevel
    spline = data.splines.new("POLY")
    spline.points.add(len(points) - 1)
    for point, place_of in zip(spline.points, points, strict=True):
        point.co = (*place_of, 1)
    spline.use_cyclic_u = cyclic
    ob = bpy.data.objects.new("Guide", data)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    return ob


def follow(ob, **properties):
    chosen = {"flow_source": "CURVES", "flow_curves": "Guide", "flow_angle": ANGLE}
    return add_hair(ob, **chosen | properties)


@pytest.mark.every(3)
@pytest.mark.parametrize("bevel", [0.0, 0.3])
@pytest.mark.parametrize("transform", TRANSFORMS)
def test_one_straight_curve_combs_a_whole_flat_sheet(transform, bevel):
    """The curve stands in the world, above the sheet, and may be thick."""
    ob = scenes.flat_grid(SIDE)
    place(ob, TRANSFORMS[transform])
    start, towards = np.array([3.0, 3.0, 0.2]), np.array([0.8, 0.6, 0])
    guide = add_curve(
        transformed(ob.matrix_world, start + np.outer([0, 1, 3], towards)) - [1, 2, 3], bevel=bevel
    )
    guide.location = (1, 2, 3)
    direction, _ = world_directions(follow(ob))
    expected = leaning(ob, towards, ANGLE)
    np.testing.assert_allclose(direction, np.broadcast_to(expected, direction.shape), atol=3e-5)


def test_directions_turn_linearly_from_one_curve_to_another():
    """Between two parallel lines across a strip the vectors that change least are linear."""
    ob = scenes.flat_grid(SIDE)
    add_subsurf(ob, "PRESERVE_CORNERS")  # the limit surface is the whole square
    count = 400
    y = np.linspace(0, SIDE, count, endpoint=False)
    step = SIDE / count
    start = np.stack([np.full(count, 6 - step / 2), y, 0 * y], axis=1)
    pieces = np.stack([start, start + [step, step, 0]], axis=1)  # at 45 degrees across x = 6
    hair = bpy.data.hair_curves.new("Hair")
    hair.add_curves([2] * (count + 1))
    line = np.array([[[2, 0, 0], [2, SIDE, 0]]])
    positions = np.concatenate([line, pieces]).astype(np.float32)
    hair.points.foreach_set("position", positions.ravel())
    bpy.context.collection.objects.link(bpy.data.objects.new("Hair", hair))
    bpy.context.view_layer.update()
    direction, root = world_directions(follow(ob, flow_curves="Hair", flow_angle=np.pi / 2))
    part = np.clip((root[:, :1] - 2) / 4, 0, 1)
    expected = unit((1 - part) * [0, 1, 0] + part * unit(np.array([1.0, 1, 0])))
    np.testing.assert_allclose(direction, expected, atol=4e-3)


def test_closed_curves_go_round():
    """Around a circle in the middle of a disc-like sheet all strands go round."""
    ob = scenes.flat_grid(SIDE)
    turn = np.linspace(0, 2 * np.pi, 256, endpoint=False)
    ring = np.stack([4 + 2 * np.cos(turn), 4 + 2 * np.sin(turn), 0 * turn], axis=1)
    add_curve(ring, cyclic=True)
    direction, root = world_directions(follow(ob, flow_angle=np.pi / 2, per_side=8))
    x, y = (root[:, :2] - 4).T
    radius = np.hypot(x, y)
    near = np.abs(radius - 2) < 0.1
    assert near.sum() > 40
    around = np.stack([-y, x, 0 * x], axis=1) / radius[:, None]
    cosine = np.einsum("ni,ni->n", direction, around)
    assert cosine[near].min() > 0.998
    assert cosine[radius > 0.5].min() > 0.9


def test_curves_leave_nothing_behind():
    ob = scenes.flat_grid(2)
    add_curve([(0, 0, 0), (1, 1, 0)], bevel=0.1)
    before = scenes.file_contents()
    hair = follow(ob)
    after = scenes.file_contents()
    assert set(after["objects"]) - set(before["objects"]) == {hair.name}
    assert after["node_groups"] == before["node_groups"]
    assert after["curves"] == before["curves"]
    assert after["meshes"] == before["meshes"]


@pytest.mark.parametrize(
    ("match", "points"),
    [
        ("Guide: no part of a curve runs along the surface", [(1, 1, 0), (1, 1, 2)]),
        ("Guide has no curves", [(1, 1, 0)]),
    ],
)
def test_curves_that_say_nothing(match, points):
    scenes.activate(scenes.flat_grid(2))
    add_curve(points)
    check_hair_refused(f"Flow: {match}", {"flow_source": "CURVES", "flow_curves": "Guide"})


def test_objects_that_hold_no_curves():
    scenes.flat_grid(2)
    refused = {"flow_source": "CURVES"}
    for name, text in (
        ("Nix", "There is no object 'Nix': choose curves or hair"),
        ("Flat", "Flat is neither a curve object nor hair"),
    ):
        check_hair_refused(f"Flow: {text}", refused | {"flow_curves": name})
