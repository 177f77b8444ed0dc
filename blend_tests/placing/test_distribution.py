# SPDX-License-Identifier: GPL-3.0-or-later
"""Uniform and blue noise: number, places and distances, in the world's units."""

import areas
import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from mathutils import Vector
from refusals import check_refused
from scenes import MIRRORED, STRETCHED, add_hair, add_points, add_subsurf, locations, place


def world_positions(points):
    local = attributes.read(points.data, "position").astype(np.float64)
    return scenes.transformed(points.matrix_world, local)


def nearest_distances(points):
    """Returns the distance of each point to the nearest one whose normal is less than 90 degrees
    from its own.
    """
    p = world_positions(points)
    inverse = np.linalg.inv(np.array(points.matrix_world)[:3, :3])
    n = attributes.read(points.data, ids.NORMAL) @ inverse
    distance = np.linalg.norm(p[:, None] - p[None], axis=2)
    distance[n @ n.T <= 0] = np.inf
    np.fill_diagonal(distance, np.inf)
    return distance.min(axis=1)


@pytest.mark.parametrize("transform", [{}, STRETCHED, MIRRORED])
@pytest.mark.parametrize("scene", ["grid with holes", "mixed polygons"])
def test_uniform_by_area_in_the_world(scene, transform):
    ob = scenes.SCENES[scene]()
    add_subsurf(ob)
    place(ob, transform)
    points = add_points(ob, distribution="UNIFORM", count=20_000, seed=1)
    areas.check_parts(locations(points.data)[0], areas.expected_parts(ob))


@pytest.mark.parametrize("distribution", ["UNIFORM", "BLUE_NOISE"])
@pytest.mark.parametrize("count", [1, 17, 300])
def test_exactly_so_many(distribution, count):
    ob = scenes.cross()
    assert len(add_hair(ob, distribution=distribution, count=count).data.curves) == count


@pytest.mark.parametrize("transform", [{}, STRETCHED, MIRRORED])
@pytest.mark.parametrize("scene", ["cross", "mixed polygons"])
def test_blue_noise_keeps_its_distance_in_the_world(scene, transform):
    ob = scenes.SCENES[scene]()
    place(ob, transform)
    points = add_points(ob, distribution="BLUE_NOISE", distance=0.15, seed=2)
    nearest = nearest_distances(points)
    assert nearest.min() >= 0.15 * (1 - 1e-5)  # single precision
    assert np.median(nearest) < 0.15 * 1.6
    assert len(nearest) > 0.5 * areas.cell_areas(ob).sum() / 0.15**2


def test_blue_noise_by_count_says_what_distance_it_keeps(capfd):
    points = add_points(scenes.cross(), distribution="BLUE_NOISE", count=200)
    reported = capfd.readouterr().out
    said = float(reported.split("at least ")[1].split(" ")[0])
    assert said == pytest.approx(nearest_distances(points).min(), rel=0.1)
    assert said <= nearest_distances(points).min() * 1.001


@pytest.mark.parametrize("distribution", ["UNIFORM", "BLUE_NOISE"])
def test_density_counts_square_units_of_the_world(distribution):
    ob = scenes.grid_with_holes()
    place(ob, STRETCHED)
    area = areas.cell_areas(ob).sum()
    points = add_points(ob, distribution=distribution, density=20)
    assert len(points.data.vertices) == pytest.approx(20 * area, rel=0.005, abs=1)


@pytest.mark.parametrize("distribution", ["JITTERED", "UNIFORM", "BLUE_NOISE"])
def test_a_seed_gives_one_arrangement(distribution):
    ob = scenes.cross()
    made = [
        locations(add_points(ob, distribution=distribution, count=50, seed=seed).data)
        for seed in (4, 4, 5)
    ]
    for once, again in zip(made[0], made[1], strict=True):
        np.testing.assert_array_equal(once, again)
    assert not np.array_equal(made[0][1], made[2][1])


@pytest.mark.parametrize("distribution", ["UNIFORM", "BLUE_NOISE"])
def test_places_do_not_depend_on_where_the_object_stands(distribution):
    ob = scenes.cross()
    found = []
    for where in ((0, 0, 0), (1e6, -3e5, 7e5)):  # in single precision an edge has few digits there
        ob.location = where
        bpy.context.view_layer.update()
        hair = add_hair(ob, distribution=distribution, count=60, seed=3)
        found.append([attributes.read(hair.data, name) for name in (ids.FACE, ids.UV)])
    for here, far_away in zip(*found, strict=True):
        np.testing.assert_array_equal(here, far_away)


def test_hair_and_points_at_the_same_places():
    ob = scenes.mixed_polygons()
    settings = {"distribution": "BLUE_NOISE", "count": 60, "seed": 3}
    points, hair = add_points(ob, **settings).data, add_hair(ob, **settings).data
    for name in (ids.FACE, ids.UV, ids.REST_ROOT, ids.REST_ROTATION):
        np.testing.assert_array_equal(attributes.read(points, name), attributes.read(hair, name))


def test_roots_lie_where_their_attributes_say():
    ob = scenes.grid_with_holes()
    place(ob, STRETCHED)
    points = add_points(ob, distribution="UNIFORM", count=500)
    surface = scenes.surface_without_addon(ob)
    exact = surface.evaluate(*locations(points.data)).position.astype(np.float32)
    np.testing.assert_array_equal(attributes.read(points.data, "position"), exact)


@pytest.mark.parametrize(
    ("given", "amount"),
    [({"count": 5}, "COUNT"), ({"density": 5.0}, "DENSITY"), ({"distance": 0.5}, "DISTANCE")],
)
def test_scripts_need_not_say_what_kind_of_amount_they_give(given, amount):
    ob = scenes.cross()
    left_out, said = (
        locations(add_points(ob, distribution="BLUE_NOISE", **given | more).data)
        for more in ({}, {"amount": amount})
    )
    np.testing.assert_array_equal(left_out[1], said[1])


def test_two_amounts_are_refused():
    scenes.cross()
    check_refused("count and distance are given", distribution="BLUE_NOISE", count=3, distance=0.1)


def test_uniform_with_a_distance_is_refused():
    scenes.cross()
    check_refused("Uniform keeps no distance", distribution="UNIFORM", distance=0.1)


def test_too_low_a_density_is_refused():
    scenes.cross()
    check_refused("so low that no place was found", distribution="UNIFORM", density=1e-5)


@pytest.mark.parametrize("distribution", ["UNIFORM", "BLUE_NOISE"])
def test_an_object_without_area_is_refused(distribution):
    place(scenes.flat_grid(2), {"scale": (0, 1, 1)})
    check_refused("no area|has a scale of 0", distribution=distribution, count=10)


@pytest.mark.parametrize("amount", [{"count": 10}, {"density": 10.0}])
def test_a_collapsed_mesh_is_refused(amount):
    scenes.add_mesh("Collapsed", [(0, 0, 0)] * 4, [(0, 1, 2, 3)])
    check_refused("has no area", distribution="UNIFORM", **amount)


@pytest.mark.parametrize("given", [{"count": 4_000_000}, {"density": 1e6}, {"distance": 5e-4}])
def test_millions_need_consent(given):
    scenes.cross()
    check_refused("allow_large", distribution="BLUE_NOISE", **given)


def test_adjusting_as_the_redo_panel_does():
    scenes.cross()
    bpy.ops.ed.undo_push(message="before")
    for count in (20, 70):
        bpy.ops.object.limit_hair_add("EXEC_DEFAULT", distribution="BLUE_NOISE", count=count)
        bpy.ops.ed.undo_push(message="after")
        assert len(bpy.context.active_object.data.curves) == count
        bpy.ops.ed.undo()
        assert bpy.context.active_object.name == "Cross"
        assert not bpy.data.hair_curves


@pytest.mark.parametrize("target", ["VIEWPORT", "RENDER"])
def test_roots_on_the_mesh_that_is_shown(target):
    """At level 1 quads are split in 2 x 2; their corners are Blender's own vertices."""
    ob = scenes.grid_with_holes()
    subsurf = add_subsurf(ob)
    subsurf.levels, subsurf.render_levels = (1, 3) if target == "VIEWPORT" else (3, 1)
    points = add_points(ob, per_side=20, target=target)
    exact = add_points(ob, per_side=20)
    for name in (ids.FACE, ids.UV, ids.REST_ROTATION):
        np.testing.assert_array_equal(
            attributes.read(points.data, name), attributes.read(exact.data, name)
        )
    position = attributes.read(points.data, "position")
    np.testing.assert_array_equal(attributes.read(points.data, ids.REST_ROOT), position)
    assert np.abs(position - attributes.read(exact.data, "position")).max() > 1e-3
    subsurf.levels = 1
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    off = [
        (shown.closest_point_on_mesh(p.tolist())[1] - Vector(p.tolist())).length for p in position
    ]
    assert max(off) < 2e-6
