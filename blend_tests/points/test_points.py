# SPDX-License-Identifier: GPL-3.0-or-later
"""Points have the same locations as hair, with frames, and instances by stock nodes."""

import math

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.nodes import groups
from limit_surface.reading import attributes
from scenes import add_hair, add_mesh, add_points, add_subsurf, locations, surface_without_addon


@pytest.mark.parametrize("scene", scenes.SCENES)
def test_positions_and_frames(scene):
    ob = scenes.SCENES[scene]()
    add_subsurf(ob)
    points = add_points(ob)
    data, surface = points.data, surface_without_addon(ob)
    roots = surface.evaluate(*locations(data)).position.astype(np.float32)
    for name in ("position", ids.REST_ROOT):
        np.testing.assert_array_equal(attributes.read(data, name), roots)
    frames = surface.frames(*locations(data)).astype(np.float32)
    np.testing.assert_array_equal(attributes.read(data, ids.TANGENT), frames[:, :, 0])
    np.testing.assert_array_equal(attributes.read(data, ids.NORMAL), frames[:, :, 2])
    for name in (ids.ROTATION, ids.REST_ROTATION):
        assert data.attributes[name].data_type == "QUATERNION"
    assert not data.polygons
    assert not data.edges


def test_same_places_as_hair():
    ob = scenes.mixed_polygons()
    points, hair = add_points(ob, seed=3).data, add_hair(ob, seed=3).data
    for name in (ids.FACE, ids.UV, ids.REST_ROOT, ids.REST_ROTATION):
        np.testing.assert_array_equal(attributes.read(points, name), attributes.read(hair, name))


def instances(points):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return [
        (i.object.original, np.array(i.matrix_world))
        for i in depsgraph.object_instances
        if i.is_instance and i.parent.original == points
    ]


def test_instances_stand_on_the_points():
    thorn = add_mesh("Thorn", [(0, 0, 0), (0.1, 0, 0), (0, 0, 1)], [(0, 1, 2)])
    thorn.location, thorn.rotation_euler, thorn.scale = (9, 9, 9), (1, 1, 1), (3, 3, 3)
    ob = scenes.cross()
    ob.location, ob.rotation_euler, ob.scale = (1, 2, 3), (0.4, 0.5, 0.6), (2, 2, 2)
    points = add_points(ob, per_side=3, instance="Thorn")
    found = instances(points)
    assert len(found) == 45
    assert {made for made, _ in found} == {thorn}
    matrix = np.array(ob.matrix_world)
    position = scenes.transformed(matrix, attributes.read(points.data, "position"))
    frames = surface_without_addon(ob).frames(*locations(points.data))
    shown = np.array([world for _, world in found])
    np.testing.assert_allclose(shown[:, :3, 3], position, atol=1e-5)
    np.testing.assert_allclose(shown[:, :3, :3], matrix[:3, :3] @ frames, atol=1e-5)


def test_one_node_group_for_all():
    thorn = add_mesh("Thorn", [(0, 0, 0), (0.1, 0, 0), (0, 0, 1)], [(0, 1, 2)])
    ob = scenes.cross()
    first, second = (add_points(ob, per_side=k, instance=thorn.name) for k in (1, 2))
    assert len(bpy.data.node_groups) == 1
    assert [len(instances(points)) for points in (first, second)] == [5, 20]


def test_without_instance_no_modifier():
    assert not add_points(scenes.cross()).modifiers
    assert not bpy.data.node_groups


def test_an_instance_that_does_not_exist():
    scenes.cross()
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="no object 'Thron'"):
        bpy.ops.object.limit_points_add(instance="Thron")
    assert scenes.file_contents() == before


def test_save_and_load_with_instances(tmp_path):
    add_mesh("Thorn", [(0, 0, 0), (0.1, 0, 0), (0, 0, 1)], [(0, 1, 2)])
    name = add_points(scenes.cross(), per_side=2, instance="Thorn").name
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "points.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "points.blend"))
    assert len(instances(bpy.data.objects[name])) == 20


def scale_of(points):
    """Returns the vertices of the scale that stands on the points."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    meshes = [i.object.data for i in depsgraph.object_instances if i.parent and i.is_instance]
    return attributes.read(meshes[0], ids.POSITION)


def test_scales_by_stock_nodes():
    ob = scenes.cross()
    ob.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    points = add_points(ob, per_side=3, instances="SCALE", instance="Nothing", scale_length=0.3)
    (modifier,) = points.modifiers
    assert modifier.name == ids.SCALES_GROUP
    depsgraph = bpy.context.evaluated_depsgraph_get()
    shown = np.array(
        [np.array(i.matrix_world) for i in depsgraph.object_instances if i.is_instance]
    )
    matrix = np.array(ob.matrix_world)
    at = scenes.transformed(matrix, attributes.read(points.data, "position"))
    np.testing.assert_allclose(shown[:, :3, 3], at, atol=1e-5)
    frames = surface_without_addon(ob).frames(*locations(points.data))
    np.testing.assert_allclose(shown[:, :3, :3], matrix[:3, :3] @ frames, atol=1e-5)
    scale = 2 * scale_of(points).astype(np.float64)  # in the world
    tip = scale[scale[:, 0].argmax()]
    np.testing.assert_allclose(np.linalg.norm(tip), 0.3, rtol=1e-5)  # along u, above the surface
    assert tip[1] == pytest.approx(0, abs=1e-6)
    assert tip[2] > 0
    assert scale[:, 2].min() > -1e-6
    assert 0.15 < np.ptp(scale[:, 1]) <= 0.24


def test_scales_can_be_turned_and_laid_flat():
    points = add_points(scenes.cross(), per_side=1, instances="SCALE", scale_length=0.3)
    before = scale_of(points)
    groups.set_input(points.modifiers[0], "Turn", math.pi / 2)
    groups.set_input(points.modifiers[0], "Lift", 0.0)
    after = scale_of(points)
    np.testing.assert_allclose(after[:, 0], -before[:, 1], atol=1e-6)
    assert np.ptp(after[:, 1]) == pytest.approx(0.3, abs=1e-6)
    assert after[:, 2].max() < 0.3 * np.sin(0.24) < before[:, 2].max()
