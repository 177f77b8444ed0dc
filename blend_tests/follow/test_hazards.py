# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in which things could silently follow to wrong places: modifiers that are on in renders
only, data shared by two surfaces, vertices in another order, places far from the world's origin,
poles, and groups that users have changed.
"""

import bmesh
import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.nodes import groups
from limit_surface.placing.follow_state import State
from limit_surface.reading import attributes
from mathutils import Euler, Matrix


def shown_error(ob: bpy.types.Object, hair: bpy.types.Object) -> float:
    now = follow_truth.on_surface(ob, hair.data)
    expected = follow_truth.moved(scenes.strands(hair), hair.data, now)
    error = np.abs(follow_truth.shown_strands(hair) - expected).max()
    return float(error / follow_truth.diagonal(ob))


def deforming_cross() -> bpy.types.Object:
    ob = scenes.cross()
    follow_truth.animate(ob)
    scenes.add_subsurf(ob)
    return ob


@pytest.mark.parametrize("change", ["before binding", "after binding"])
def test_a_subdivision_for_renders_alone(change):
    ob = scenes.cross()
    follow_truth.animate(ob)
    subsurf = scenes.add_subsurf(ob, "PRESERVE_CORNERS")
    if change == "before binding":
        subsurf.show_viewport = False
    hair = scenes.add_hair(ob, follow="NODES")
    subsurf.show_viewport = False
    assert [m.type for m in ob.modifiers] == ["WAVE", "NODES", "SUBSURF"]
    bpy.context.scene.frame_set(30)
    hidden = follow_truth.shown_strands(hair)
    assert shown_error(ob, hair) < follow_truth.POSITION_BOUND
    subsurf.show_viewport = True
    np.testing.assert_allclose(follow_truth.shown_strands(hair), hidden, atol=1e-6)


def test_different_subdivisions_in_viewport_and_renders_are_refused():
    ob = deforming_cross()
    scenes.add_subsurf(ob)
    ob.modifiers["Subdivision"].show_viewport = False
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="subdivided first by Subdivision.001 in the viewport"):
        bpy.ops.object.limit_hair_add(follow="NODES")
    assert scenes.file_contents() == before


def test_a_modifier_behind_the_capture_is_told_where_nothing_subdivides():
    ob = scenes.cross()
    ob.shape_key_add(name="Basis")
    scenes.add_hair(ob)
    assert not State.of(ob).troubles(None)
    ob.modifiers.new("Cast", "CAST")
    (trouble,) = State.of(ob).troubles(None)
    assert "must be the last modifier" in trouble.text


def test_data_of_two_surfaces_are_refused():
    ob = deforming_cross()
    hair = scenes.add_hair(ob, follow="NODES")
    other = ob.copy()
    bpy.context.collection.objects.link(other)
    twin = hair.copy()
    bpy.context.collection.objects.link(twin)
    twin.parent = other
    for modifier in twin.modifiers:
        groups.set_input(modifier, "Surface", other)
    scenes.activate(twin)
    for selected in bpy.context.selected_objects:
        selected.select_set(False)
    with pytest.raises(RuntimeError, match="shares its data with"):
        bpy.ops.object.limit_follow()


def test_vertices_far_apart_in_number_are_told_from_each_other():
    ob = scenes.flat_grid(70)
    follow_truth.animate(ob)
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, distribution="UNIFORM", count=50, follow="NODES")
    bpy.context.scene.frame_set(30)
    assert shown_error(ob, hair) < follow_truth.POSITION_BOUND
    edited = bmesh.new()
    edited.from_mesh(ob.data)
    swapped = {10: 10 + 4093, 10 + 4093: 10}
    edited.verts.sort(key=lambda vertex: swapped.get(vertex.index, vertex.index))
    edited.to_mesh(ob.data)
    edited.free()
    bpy.context.view_layer.update()
    np.testing.assert_allclose(follow_truth.shown_strands(hair), scenes.strands(hair), atol=1e-6)


def test_the_distance_from_the_origin_costs_no_digits():
    ob = deforming_cross()
    turned = Euler((0.3, 0.5, -0.7)).to_matrix().to_4x4()
    ob.matrix_world = Matrix.Translation((1e4, -2e4, 3e3)) @ turned
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.context.scene.frame_set(30)
    assert shown_error(ob, hair) < follow_truth.POSITION_BOUND


def test_what_is_bound_at_a_pole_does_not_move():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=8)
    ob = bpy.context.active_object
    scenes.add_subsurf(ob)
    points = scenes.add_mesh("Points", [(0, 0, 2), (0, 0, -2), (0, 0, 0.99)], [])
    scenes.activate(ob)
    bpy.ops.object.limit_follow()
    assert ids.TILE in points.data.attributes
    before = attributes.read(points.data, ids.POSITION)
    np.testing.assert_allclose(follow_truth.shown(points, ids.POSITION), before, atol=4e-6)


def test_binding_more_things_keeps_the_fast_viewport():
    ob = deforming_cross()
    scenes.activate(scenes.add_hair(ob, follow="NONE"))
    bpy.ops.object.limit_follow(use_proxy=True)
    scenes.activate(scenes.add_points(ob, follow="NONE"))
    bpy.ops.object.limit_follow()
    assert f"{ids.PROXY_OBJECT} of Cross" in bpy.data.objects


def test_a_group_with_a_renamed_input_is_an_error_that_says_so():
    ob = deforming_cross()
    hair = scenes.add_hair(ob, follow="NODES")
    hair.modifiers[0].node_group.interface.items_tree["Tiles"].name = "Mine"
    scenes.activate(hair)
    with pytest.raises(RuntimeError, match="has no input Tiles any more"):
        bpy.ops.object.limit_follow()


def test_points_without_coordinates_are_refused():
    ob = deforming_cross()
    points = scenes.add_mesh("Points", [(0, 0, 2), (0, float("nan"), 1)], [])
    points.select_set(True)
    scenes.activate(ob)
    with pytest.raises(
        RuntimeError, match="Vertex 1 of Points has a coordinate that is not a finite number"
    ):
        bpy.ops.object.limit_follow()


def test_a_mesh_that_an_armature_deforms_as_well_is_told(capfd):
    ob = deforming_cross()
    points = scenes.add_mesh("Points", [(0, 0, 2)], [])
    points.modifiers.new("Bones", "ARMATURE")
    scenes.activate(ob)
    bpy.ops.object.limit_follow()
    assert "its modifier Bones deforms it as well" in capfd.readouterr().out


def test_one_refused_thing_leaves_all_others_as_they_were():
    ob = deforming_cross()
    hair = scenes.add_hair(ob, follow="NONE")
    data = bpy.data.curves.new("Flat", "CURVE")
    data.dimensions = "3D"
    data.splines.new("POLY").points.add(3)
    flat = bpy.data.objects.new("Flat", data)
    bpy.context.collection.objects.link(flat)
    flat.scale.z = 0
    for thing in (hair, flat, ob):
        thing.select_set(True)
    scenes.activate(ob)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="scale of 0"):
        bpy.ops.object.limit_follow()
    assert scenes.file_contents() == before
    assert not hair.modifiers
    assert ids.TILE not in hair.data.attributes


def test_what_deleted_hair_leaves_behind_can_be_removed():
    ob = deforming_cross()
    before = {o.name for o in bpy.data.objects}
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.data.objects.remove(hair)
    scenes.activate(ob)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert {o.name for o in bpy.data.objects} == before
    assert [m.type for m in ob.modifiers] == ["WAVE", "SUBSURF"]
