# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces chosen by material slots and by selection: nothing is made on any other face."""

from operator import itemgetter

import areas
import bpy
import numpy as np
import pytest
import scenes
from limit_surface.reading import attributes
from limit_surface.reading.subdivided_mesh import ptex_face_counts
from refusals import check_refused
from scenes import add_hair, add_points, locations

DISTRIBUTIONS = [
    {"distribution": "JITTERED", "per_side": 5},
    {"distribution": "UNIFORM", "count": 5000},
    {"distribution": "BLUE_NOISE", "distance": 0.08},
]


def with_materials(ob, slots=3):
    """Sets and returns the material slot of each polygon."""
    for i in range(slots):
        ob.data.materials.append(bpy.data.materials.new(f"M{i}"))
    chosen = np.arange(len(ob.data.polygons), dtype=np.int32) % slots
    ob.data.polygons.foreach_set("material_index", chosen)
    return chosen


def ptex_polygons(ob):
    """Returns the polygon of each Ptex face."""
    sizes = attributes.face_sizes(ob.data)
    return np.repeat(np.arange(len(sizes)), ptex_face_counts(sizes))


def covered_polygons(ob, made):
    return np.unique(ptex_polygons(ob)[locations(made.data)[0]])


@pytest.mark.parametrize("properties", DISTRIBUTIONS, ids=itemgetter("distribution"))
@pytest.mark.parametrize("slots", [{"1"}, {"0", "2"}])
def test_material_slots(properties, slots):
    ob = scenes.mixed_polygons()
    slot = with_materials(ob)
    points = add_points(ob, material_slots=slots, **properties)
    wanted = np.flatnonzero(np.isin(slot, [int(s) for s in slots]))
    np.testing.assert_array_equal(covered_polygons(ob, points), wanted)


@pytest.mark.parametrize("properties", DISTRIBUTIONS, ids=itemgetter("distribution"))
def test_selected_faces(properties):
    ob = scenes.grid_with_holes()
    wanted = [2, 3, 11]
    select = np.isin(np.arange(len(ob.data.polygons)), wanted)
    ob.data.polygons.foreach_set("select", select)
    points = add_points(ob, faces="SELECTED", **properties)
    np.testing.assert_array_equal(covered_polygons(ob, points), wanted)


@pytest.mark.parametrize("properties", DISTRIBUTIONS, ids=itemgetter("distribution"))
def test_a_face_attribute_and_material_slots_together(properties):
    ob = scenes.grid_with_holes()
    slot = with_materials(ob)
    scalp = np.arange(len(slot)) < 9
    attributes.write(ob.data, "scalp", "BOOLEAN", "FACE", scalp)
    properties = {**properties, "face_attribute": "scalp", "material_slots": {"0"}}
    hair = add_hair(ob, faces="ATTRIBUTE", **properties)
    wanted = np.flatnonzero(scalp & (slot == 0))
    np.testing.assert_array_equal(covered_polygons(ob, hair), wanted)


def test_the_surface_is_the_same_with_a_mask():
    """Faces that are not covered still shape the surface."""
    ob = scenes.cross()
    ob.data.polygons.foreach_set("select", [True] + 4 * [False])
    all_over, masked = add_points(ob, seed=4), add_points(ob, seed=4, faces="SELECTED")
    here = locations(all_over.data)[0] == 0
    np.testing.assert_array_equal(
        attributes.read(all_over.data, "position")[here], attributes.read(masked.data, "position")
    )


def test_uniform_by_area_on_what_is_covered():
    ob = scenes.grid_with_holes()
    slot = with_materials(ob)
    points = add_points(ob, distribution="UNIFORM", count=10_000, material_slots={"0", "1"})
    parts = np.where(slot == 2, 0, areas.expected_parts(ob))
    areas.check_parts(locations(points.data)[0], parts / parts.sum())


def test_density_is_that_of_what_is_covered():
    ob = scenes.grid_with_holes()
    slot = with_materials(ob)
    points = add_points(ob, distribution="UNIFORM", density=50, material_slots={"1"})
    area = areas.cell_areas(ob).reshape(len(slot), -1).sum(axis=1)[slot == 1].sum()
    assert len(points.data.vertices) == pytest.approx(50 * area, rel=0.005, abs=1)


def test_faces_that_modifiers_make_keep_their_selection_and_slot():
    ob = scenes.grid_with_holes()
    count = len(ob.data.polygons)
    with_materials(ob)
    ob.data.polygons.foreach_set("select", np.arange(count) < 6)
    ob.modifiers.new("Mirror", "MIRROR").use_axis = (False, True, False)
    points = add_points(ob, per_side=2, faces="SELECTED", material_slots={"1"})
    found = np.unique(locations(points.data)[0])
    np.testing.assert_array_equal(found, [1, 4, count + 1, count + 4])


def test_the_report_counts_covered_faces_alone(capfd):
    ob = scenes.grid_with_holes()
    ob.data.polygons.foreach_set("select", np.arange(len(ob.data.polygons)) < 6)
    add_points(ob, per_side=2, faces="SELECTED")
    reported = capfd.readouterr().out
    assert "24 points on 6 faces of Holes" in reported
    assert "hole" not in reported.lower().replace("holes", "")


def test_nothing_selected():
    ob = scenes.cross()
    ob.data.polygons.foreach_set("select", 5 * [False])
    check_refused("none of the faces is selected", faces="SELECTED")


def test_slots_without_faces():
    ob = scenes.cross()
    with_materials(ob, 3)
    ob.data.polygons.foreach_set("material_index", np.zeros(5, np.int32))
    check_refused("no face has a material of the slots 1, 2", material_slots={"1", "2"})


def test_a_slot_that_does_not_exist():
    with_materials(scenes.cross(), 2)
    with pytest.raises((TypeError, ValueError), match="'7' not found"):
        bpy.ops.object.limit_hair_add(material_slots={"7"})


def test_more_slots_than_can_be_chosen():
    ob = scenes.grid_with_holes()
    slot = with_materials(ob, 40)
    slot[:] = np.arange(len(slot)) + 17
    ob.data.polygons.foreach_set("material_index", slot)
    points = add_points(ob, per_side=2, material_slots={"30", "18"})
    np.testing.assert_array_equal(covered_polygons(ob, points), [1, 13])
    with pytest.raises((TypeError, ValueError), match="'31' not found"):
        bpy.ops.object.limit_points_add(material_slots={"31"})


def test_attributes_that_choose_no_faces():
    ob = scenes.cross()
    chosen_by = {"faces": "ATTRIBUTE", "face_attribute": "scalp"}
    check_refused("no attribute 'scalp'", **chosen_by)
    attributes.write(ob.data, "scalp", "FLOAT", "FACE", np.ones(5))
    check_refused("FLOAT on FACE, not BOOLEAN on FACE", **chosen_by)
