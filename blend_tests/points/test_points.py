# SPDX-License-Identifier: GPL-3.0-or-later
"""Points have the same locations as hair, with frames, and instances by stock nodes."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
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
