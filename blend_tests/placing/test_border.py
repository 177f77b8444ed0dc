# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points along borders: places by true arc length, directions, and what is refused."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from refusals import check_refused
from scenes import MIRRORED, STRETCHED, add_hair, add_points, add_subsurf, locations, place


def surface_in_world(ob):
    surface = scenes.surface_without_addon(ob)
    surface.set_positions(scenes.transformed(ob.matrix_world, surface.positions))
    return surface


def boundary_loops(ob):
    """Returns the vertices of each boundary of a mesh, in order, from its faces alone."""
    after = {}
    for polygon in ob.data.polygons:
        corners = list(polygon.vertices)
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            if after.get(a) != b:
                after.setdefault((a, b), None)
    edges = {edge for edge in after if isinstance(edge, tuple)}
    open_edges = dict(edge for edge in edges if edge[::-1] not in edges)
    loops = []
    while open_edges:
        start, vertex = open_edges.popitem()
        loop = [start]
        while vertex != start:
            loop.append(vertex)
            vertex = open_edges.pop(vertex)
        loops.append(loop)
    return loops


def spline(points, samples=2000):
    """Returns points on the closed uniform cubic B-spline of `points`, in order."""
    t = np.arange(samples)[:, None] / samples
    weights = (1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3
    count = len(points)
    parts = [
        sum(w * points[(i + j) % count] for j, w in enumerate(weights)) / 6 for i in range(count)
    ]
    return np.concatenate(parts)


@pytest.mark.every(4)
@pytest.mark.parametrize("transform", [{}, STRETCHED, MIRRORED])
@pytest.mark.parametrize("scene", ["cross", "grid with holes", "mixed polygons"])
def test_even_along_the_boundary_by_length_in_the_world(scene, transform):
    ob = scenes.SCENES[scene]()
    add_subsurf(ob)
    place(ob, transform)
    points = add_points(ob, distribution="BORDER", count=300, seed=1)
    assert len(points.data.vertices) == 300
    local = attributes.read(points.data, "position").astype(np.float64)
    at = scenes.transformed(points.matrix_world, local)
    positions = surface_in_world(ob).positions
    found = 0
    for loop in boundary_loops(ob):
        curve = spline(positions[loop])
        near = np.linalg.norm(at[:, None] - curve[None], axis=2)
        length = np.linalg.norm(np.diff(curve, axis=0, append=curve[:1]), axis=1)
        arcs = np.concatenate([[0], np.cumsum(length)])
        on = near.min(axis=1) < length.max()
        place_on_curve = np.sort(arcs[near[on].argmin(axis=1)])
        gaps = np.diff(place_on_curve, append=place_on_curve[0] + arcs[-1])
        np.testing.assert_allclose(gaps, arcs[-1] / on.sum(), atol=3 * length.max())
        found += on.sum()
    assert found == 300


def test_roots_lie_where_their_attributes_say():
    ob = scenes.grid_with_holes()
    place(ob, STRETCHED)
    points = add_points(ob, distribution="BORDER", count=500)
    surface = scenes.surface_without_addon(ob)
    exact = surface.evaluate(*locations(points.data)).position.astype(np.float32)
    np.testing.assert_array_equal(attributes.read(points.data, "position"), exact)


def test_hair_and_points_at_the_same_places():
    ob = scenes.mixed_polygons()
    settings = {"distribution": "BORDER", "count": 60, "seed": 3, "border_jitter": 0.7}
    points, hair = add_points(ob, **settings).data, add_hair(ob, **settings).data
    for name in (ids.FACE, ids.UV, ids.REST_ROOT, ids.REST_ROTATION):
        np.testing.assert_array_equal(attributes.read(points, name), attributes.read(hair, name))


def test_distance_is_the_length_between_neighbours(capfd):
    ob = scenes.cross()
    hair = add_hair(ob, distribution="BORDER", distance=0.01)
    length = surface_in_world(ob).edge_curves().lengths.sum()
    assert len(hair.data.curves) == round(length / 0.01)
    assert "strands along 1 border" in capfd.readouterr().out


def test_a_seed_moves_the_roots_and_jitter_makes_them_uneven():
    ob = scenes.cross()
    made = {
        key: locations(add_points(ob, distribution="BORDER", count=50, **settings).data)[1]
        for key, settings in {
            "even": {"seed": 4},
            "again": {"seed": 4},
            "other": {"seed": 5},
            "uneven": {"seed": 4, "border_jitter": 1.0},
        }.items()
    }
    np.testing.assert_array_equal(made["even"], made["again"])
    assert not np.array_equal(made["even"], made["other"])
    assert not np.array_equal(made["even"], made["uneven"])


@pytest.mark.parametrize("transform", [{}, STRETCHED, MIRRORED])
def test_directions_in_the_world(transform):
    ob = scenes.grid_with_holes()
    place(ob, transform)
    surface = surface_in_world(ob)
    mirrored = np.linalg.det(np.array(ob.matrix_world)[:3, :3]) < 0
    curves = surface.edge_curves()
    along = surface.scatter_along(curves, count=120, seed=2)
    normal = surface.frames(along.face, along.uv)[:, :, 2] * (-1 if mirrored else 1)
    settings = {"distribution": "BORDER", "count": 120, "seed": 2, "length": 0.5}

    def directions(**properties):
        hair = add_hair(ob, **settings | properties)
        strands = scenes.strands(hair).reshape(-1, 3).astype(np.float64)
        world = scenes.transformed(hair.matrix_world, strands).reshape(120, -1, 3)
        return (world[:, -1] - world[:, 0]) / 0.5

    lift, flow = 0.3, 0.4
    outwards = {"direction": "OUTWARDS"}
    raised = np.cos(lift) * along.outward + np.sin(lift) * normal
    leaning = np.cos(flow) * along.outward + np.sin(flow) * along.tangent
    for properties, expected in (
        ({}, normal),
        (outwards, along.outward),
        (outwards | {"lift": lift}, raised),
        (outwards | {"flow": flow}, leaning),
        ({"flow": flow}, np.cos(flow) * normal + np.sin(flow) * along.tangent),
    ):
        np.testing.assert_allclose(directions(**properties), expected, atol=1e-5)


def test_lashes_point_away_from_the_sheet():
    ob = scenes.flat_grid(6)
    hair = add_hair(ob, distribution="BORDER", count=40, direction="OUTWARDS", length=0.2)
    strands = scenes.strands(hair)
    root, tip = (np.abs(strands[:, i, :2] - 3).max(axis=1) for i in (0, -1))
    assert (tip > root).all()
    np.testing.assert_allclose(strands[:, :, 2], 0, atol=1e-6)


def test_instances_stand_along_the_border():
    ob = scenes.flat_grid(4)
    points = add_points(ob, distribution="BORDER", count=40, direction="OUTWARDS").data
    rotation = attributes.read(points, ids.ROTATION).astype(np.float64)
    w, x, y, z = rotation.T
    up = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x**2 + y**2)], axis=1)
    np.testing.assert_allclose(up, attributes.read(points, ids.NORMAL), atol=1e-6)
    assert np.abs(up[:, 2]).max() < 1e-6


def cube_with_creases():
    bpy.ops.mesh.primitive_cube_add()
    ob = bpy.context.active_object
    crease = ob.data.attributes.new("crease_edge", "FLOAT", "EDGE")
    chosen = [set(edge.vertices) <= {0, 2, 4, 6} for edge in ob.data.edges]
    crease.data.foreach_set("value", np.array(chosen, np.float32))
    return ob, np.flatnonzero(chosen)


def test_creases_sharp_edges_and_selected_edges():
    ob, chosen = cube_with_creases()
    add_subsurf(ob)
    for edge in ob.data.edges:
        edge.select = edge.use_edge_sharp = edge.index in chosen
    made = [
        locations(add_points(ob, distribution="BORDER", border=border, count=40).data)
        for border in ("CREASES", "SHARP", "SELECTED")
    ]
    for face, uv in made[1:]:
        np.testing.assert_array_equal(face, made[0][0])
        np.testing.assert_array_equal(uv, made[0][1])
    other = add_points(ob, distribution="BORDER", border="CREASES", count=40, other_side=True).data
    assert not set(locations(other)[0]) & set(made[0][0])


def test_a_selection_that_blender_stored_wrongly_is_none():
    ob = scenes.cross()
    scenes.spoil_edge_selection(ob.data)
    check_refused("Cross has no selected edges", distribution="BORDER", border="SELECTED")


def test_only_faces_that_are_covered():
    ob = scenes.flat_grid(6)
    ob.data.polygons.foreach_set("select", [polygon.center.x < 3 for polygon in ob.data.polygons])
    points = add_points(ob, distribution="BORDER", count=100, faces="SELECTED").data
    assert attributes.read(points, "position")[:, 0].max() <= 3
    assert len(points.vertices) == 100


def test_density_thins_them_out():
    ob = scenes.flat_grid(8)
    group = ob.vertex_groups.new(name="Left")
    group.add([v.index for v in ob.data.vertices if v.co.x < 4], 1.0, "REPLACE")
    points = add_points(
        ob, distribution="BORDER", count=1000, density_source="VERTEX_GROUP", vertex_group="Left"
    ).data
    assert attributes.read(points, "position")[:, 0].max() < 4
    assert 300 < len(points.vertices) < 600


def test_what_cannot_be_done_is_refused():
    bpy.ops.mesh.primitive_cube_add()
    check_refused("Cube has no open boundary", distribution="BORDER")
    check_refused("Cube has no creased edges", distribution="BORDER", border="CREASES")
    check_refused("Cube has no edges that are marked sharp", distribution="BORDER", border="SHARP")
    bpy.context.active_object.data.edges.foreach_set("select", [False] * 12)
    check_refused("Cube has no selected edges", distribution="BORDER", border="SELECTED")
    scenes.activate(scenes.cross())
    check_refused("A border has no area", distribution="BORDER", density=4.0)
    middle = scenes.flat_grid(3)
    middle.data.polygons.foreach_set("select", np.arange(9) == 4)
    check_refused("faces that are chosen have no edges", distribution="BORDER", faces="SELECTED")


def test_settings_are_called_as_in_the_panel():
    scenes.activate(scenes.cross())
    check_refused(
        "Error: Row Distance is too small", distribution="BORDER", rows=2, row_distance=1e-6
    )


@pytest.mark.parametrize("add", [add_hair, add_points])
def test_they_follow_a_mesh_that_deforms(add):
    ob = scenes.grid_with_holes()
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Bent")
    for point in key.data:
        point.co.z += 0.4 * point.co.x**2
    key.value = 0.0  # Blender 5.1 and later give new keys the value 1
    made = add(ob, distribution="BORDER", count=60, direction="OUTWARDS", follow="NODES")
    key.value = 1.0
    bpy.context.view_layer.update()
    evaluated = made.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    moved = attributes.read(evaluated, "position").reshape(60, -1, 3)[:, 0]
    exact = scenes.surface_without_addon(ob).evaluate(*locations(made.data)).position
    np.testing.assert_allclose(moved, exact, atol=2e-5)
    assert np.abs(moved - attributes.read(made.data, ids.REST_ROOT)).max() > 1


def test_rows_keep_their_distance_along_the_surface(capfd):
    ob = scenes.flat_grid(6)
    place(ob, {"scale": (2, 2, 2)})
    points = add_points(ob, distribution="BORDER", count=200, rows=4, row_distance=1.5)
    at = attributes.read(points.data, "position").astype(np.float64)
    surface = scenes.surface_without_addon(ob)
    curves = surface.edge_curves()
    dense = curves.at(0, np.linspace(0, curves.lengths[0], 20_000))
    border = surface.evaluate(dense.face, dense.uv).position
    distance = 2 * np.linalg.norm(at[:, None] - border[None], axis=2).min(axis=1)
    row = np.rint(distance / 1.5)
    np.testing.assert_allclose(distance, 1.5 * row, rtol=0.01, atol=2e-3)
    numbers = np.bincount(row.astype(int), minlength=4)
    assert numbers[0] == 200
    assert (np.diff(numbers) < 0).all()
    assert numbers[3] > 0
    said = capfd.readouterr().out
    assert "or rows would meet (missing of 200: " in said
    for lacking, name in zip(200 - numbers[1:], ("row 2", "row 3", "row 4"), strict=True):
        assert f"{lacking} in {name}" in said


def test_rows_that_do_not_end_are_not_mentioned(capfd):
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, end_fill_type="NOTHING", depth=4)
    add_points(bpy.context.active_object, distribution="BORDER", count=50, rows=3)
    said = capfd.readouterr().out
    assert "150 points along 2 borders" in said
    assert "shorter" not in said
