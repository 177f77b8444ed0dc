# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Mode: vertices of meshes, points of curves and lattices, on the target's limit surface."""

from contextlib import contextmanager

import bmesh
import bpy
import numpy as np
import pytest
import scenes
from limit_surface.reading import attributes
from snap_scenes import add_cloud, add_curve, choose_target, world_vertices
from snap_truth import Truth, add_object, near, stretched

EXACT = 1e-6


@contextmanager
def edit_mode(*objects):
    bpy.ops.object.select_all(action="DESELECT")
    for ob in objects:
        ob.select_set(True)
        scenes.activate(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    yield
    bpy.ops.object.mode_set(mode="OBJECT")


def select_vertices(ob, chosen):
    edited = bmesh.from_edit_mesh(ob.data)
    edited.select_mode = {"VERT"}
    for vertex in edited.verts:
        vertex.select = vertex.index in chosen
    edited.select_flush_mode()
    bmesh.update_edit_mesh(ob.data)


def snap(**properties):
    assert bpy.ops.object.limit_snap(**properties) == {"FINISHED"}


def test_selected_vertices_in_world_space():
    target = choose_target(stretched(scenes.grid_with_holes()))
    cloud, truth = add_cloud(target), Truth(target)
    before, stored = world_vertices(cloud), attributes.read(cloud.data, "position")
    chosen = [0, 1, 2, 5, 7, 9]
    rest = np.setdiff1d(np.arange(12), chosen)
    with edit_mode(cloud):
        select_vertices(cloud, chosen)
        snap()
        assert bpy.context.mode == "EDIT_MESH"
        edited = bmesh.from_edit_mesh(cloud.data)
        assert [vertex.index for vertex in edited.verts if vertex.select] == chosen
    after = world_vertices(cloud)
    np.testing.assert_array_equal(attributes.read(cloud.data, "position")[rest], stored[rest])
    np.testing.assert_allclose(truth.distances(after[chosen]), 0, atol=EXACT)
    moved = np.linalg.norm(after - before, axis=1)[chosen]
    np.testing.assert_allclose(moved, truth.distances(before[chosen]), atol=EXACT)


def test_hidden_vertices_stay():
    target = choose_target(scenes.cross())
    cloud = add_cloud(target)
    stored = attributes.read(cloud.data, "position")
    with edit_mode(cloud):
        select_vertices(cloud, [0, 1])
        bpy.ops.mesh.hide()
        select_vertices(cloud, [2])
        snap()
    changed = np.any(attributes.read(cloud.data, "position") != stored, axis=1)
    np.testing.assert_array_equal(np.flatnonzero(changed), [2])


def test_along_vertex_normals():
    """A small ball is inside a large one: each vertex moves straight outwards."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=4, location=(1, 2, 3))
    target = choose_target(bpy.context.object)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1, radius=1, location=(1, 2, 3))
    ball, truth = bpy.context.object, Truth(target)
    before = world_vertices(ball)
    with edit_mode(ball):
        snap(mode="NORMAL", direction="POSITIVE")
    after = world_vertices(ball)
    np.testing.assert_allclose(truth.distances(after), 0, atol=EXACT)
    # Blender's vertex normals have errors of about 1e-5.
    np.testing.assert_allclose(np.cross(after - before, before - (1, 2, 3)), 0, atol=1e-4)
    assert np.linalg.norm(after - (1, 2, 3), axis=1).min() > 3


def test_two_meshes_at_once():
    target = choose_target(scenes.cross())
    clouds, truth = [add_cloud(target, 5), add_cloud(target, 7)], Truth(target)
    with edit_mode(*clouds):
        snap()
        assert set(bpy.context.objects_in_mode) == set(clouds)
    for cloud in clouds:
        np.testing.assert_allclose(truth.distances(world_vertices(cloud)), 0, atol=EXACT)


def keys(ob):
    return {
        block.name: np.array([point.co for point in block.data])
        for block in ob.data.shape_keys.key_blocks
    }


@pytest.mark.parametrize("active", ["Basis", "First", "Second", "Aside"])
def test_shape_keys_follow_as_in_blenders_own_editing(active):
    """The same move by Blender's Move operator gives the same keys."""
    found = []
    for by_snapping in (True, False):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        choose_target(scenes.flat_grid(4))
        cloud = scenes.add_mesh("Cloud", [(1, 1, 0.5), (2, 2, 0.5), (2, 1, 0.5)], [])
        blocks = [cloud.shape_key_add(name=n) for n in ("Basis", "First", "Second", "Aside")]
        blocks[2].relative_key = blocks[1]  # which is relative to the Basis
        for i, block in enumerate(blocks[1:]):
            block.data[1].co.x += i + 0.25
            block.data[0].co.y += i + 0.25
        for block in blocks:
            block.data.foreach_set(
                "co", np.array([(p.co.x, p.co.y, 0.5) for p in block.data]).ravel()
            )
        cloud.active_shape_key_index = cloud.data.shape_keys.key_blocks.find(active)
        with edit_mode(cloud):
            select_vertices(cloud, [0, 2])
            if by_snapping:
                snap(mode="AXIS")
            else:
                bpy.ops.transform.translate(value=(0, 0, -0.5))
        found.append((keys(cloud), attributes.read(cloud.data, "position")))
    (ours, mesh), (blenders, its_mesh) = found
    assert np.ptp([block[0, 2] for block in ours.values()]) in (0, 0.5)
    for name, values in blenders.items():
        np.testing.assert_allclose(ours[name], values, atol=1e-6, err_msg=name)
    np.testing.assert_allclose(mesh, its_mesh, atol=1e-6)


def bezier(ob):
    points = ob.data.splines[0].bezier_points
    names = ("co", "handle_left", "handle_right")
    return {name: np.array([getattr(point, name) for point in points]) for name in names}


def test_bezier_handles_come_along():
    target = choose_target(stretched(scenes.cross()))
    truth = Truth(target)
    ob = add_curve("BEZIER", near(target, 5, 0.2))
    with edit_mode(ob):
        points = ob.data.splines[0].bezier_points
        for point in points:
            point.handle_left_type = point.handle_right_type = "FREE"
            point.select_control_point = False
        points[0].select_left_handle = True
        for i in (1, 3):
            points[i].select_control_point = True
        before = bezier(ob)
        snap()
        after = bezier(ob)
    world = scenes.transformed(ob.matrix_world, after["co"])
    np.testing.assert_allclose(truth.distances(world[[1, 3]]), 0, atol=EXACT)
    moved = after["co"] - before["co"]
    assert not moved[[0, 2, 4]].any()
    for name in ("handle_left", "handle_right"):
        np.testing.assert_allclose(after[name] - before[name], moved, atol=1e-6)


def test_automatic_handles_are_calculated_again():
    choose_target(scenes.flat_grid(4))
    ob = add_curve("BEZIER", [(1, 1, 0.5), (1, 4, 0.5), (2, 6, 1)])
    ob.scale, ob.location = (1, 0.5, 1), (0, 0, 0)
    with edit_mode(ob):
        bpy.ops.curve.select_all(action="SELECT")
        bpy.ops.curve.handle_type_set(type="AUTOMATIC")
        snap(mode="AXIS")
        points = ob.data.splines[0].bezier_points
        heights = [p.handle_left.z for p in points] + [p.handle_right.z for p in points]
    np.testing.assert_allclose(heights, 0, atol=1e-6)


@pytest.mark.parametrize("kind", ["POLY", "NURBS"])
def test_points_keep_their_weights(kind):
    target = choose_target(stretched(scenes.cross()))
    truth = Truth(target)
    ob = add_curve(kind, near(target, 5, 0.2))
    first = ob.data.splines.new(kind)
    first.points.add(2)
    with edit_mode(ob):
        for spline in ob.data.splines:
            for i, point in enumerate(spline.points):
                point.select = i != 2
        before = [np.array([p.co for p in spline.points]) for spline in ob.data.splines]
        snap()
        after = [np.array([p.co for p in spline.points]) for spline in ob.data.splines]
    for was, now in zip(before, after, strict=True):
        chosen = np.arange(len(was)) != 2
        np.testing.assert_array_equal(now[2], was[2])
        np.testing.assert_array_equal(now[:, 3], was[:, 3])
        world = scenes.transformed(ob.matrix_world, now[chosen, :3])
        np.testing.assert_allclose(truth.distances(world), 0, atol=EXACT)


def test_a_flat_curve_is_refused():
    choose_target(scenes.cross())
    ob = add_curve("POLY", [(0, 0, 0), (1, 1, 0)])
    ob.data.dimensions = "2D"
    with edit_mode(ob), pytest.raises(RuntimeError, match="is a 2D curve"):
        bpy.ops.object.limit_snap()


def test_surface_points():
    target = choose_target(scenes.cross())
    truth = Truth(target)
    bpy.ops.surface.primitive_nurbs_surface_surface_add(location=(0, 0, 1))
    ob = bpy.context.object
    with edit_mode(ob):
        bpy.ops.curve.select_all(action="SELECT")
        snap()
    points = np.array([p.co[:3] for p in ob.data.splines[0].points])
    np.testing.assert_allclose(
        truth.distances(scenes.transformed(ob.matrix_world, points)), 0, atol=EXACT
    )


def test_lattice_points():
    target = choose_target(stretched(scenes.cross()))
    truth = Truth(target)
    data = bpy.data.lattices.new("Lattice")
    data.points_u, data.points_v, data.points_w = 3, 2, 2
    ob = add_object(target.location, data)
    ob.rotation_euler = (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    with edit_mode(ob):
        for i, point in enumerate(ob.data.points):
            point.select = i in (0, 3, 4)
        before = np.array([point.co_deform for point in ob.data.points])
        snap()
    after = np.array([point.co_deform for point in ob.data.points])
    world = scenes.transformed(ob.matrix_world, after[[0, 3, 4]])
    np.testing.assert_allclose(truth.distances(world), 0, atol=EXACT)
    rest = np.setdiff1d(np.arange(12), [0, 3, 4])
    np.testing.assert_array_equal(after[rest], before[rest])


@pytest.mark.parametrize("kind", ["curve", "lattice"])
def test_the_active_shape_key_alone_is_changed(kind):
    choose_target(scenes.flat_grid(4))
    if kind == "curve":
        ob = add_curve("BEZIER", [(1, 1, 0.5), (2, 1, 0.6)])
    else:
        ob = add_object((2, 2, 0.3), bpy.data.lattices.new("Lattice"))
    for name in ("Basis", "Raised"):
        ob.shape_key_add(name=name)
    ob.active_shape_key_index = 1
    before = keys(ob)
    with edit_mode(ob):
        getattr(bpy.ops, kind).select_all(action="SELECT")
        snap(mode="AXIS")
    after = keys(ob)
    np.testing.assert_array_equal(after["Basis"], before["Basis"])
    heights = scenes.transformed(ob.matrix_world, after["Raised"])[:, 2]
    np.testing.assert_allclose(heights, 0, atol=1e-6)


def test_nothing_selected():
    target = choose_target(scenes.cross())
    cloud = add_cloud(target)
    with edit_mode(cloud):
        select_vertices(cloud, [])
        with pytest.raises(RuntimeError, match="Nothing that can be snapped is selected"):
            bpy.ops.object.limit_snap()


def test_without_a_target():
    cloud = add_cloud(scenes.cross())
    with edit_mode(cloud):
        assert not bpy.ops.object.limit_snap.poll()
        with pytest.raises(RuntimeError, match="Choose a target in the sidebar tab Limit"):
            bpy.ops.object.limit_snap()


def test_not_to_itself():
    target = choose_target(scenes.cross())
    with edit_mode(target), pytest.raises(RuntimeError, match="is being edited"):
        bpy.ops.object.limit_snap()


def test_vertices_have_no_rotation(capfd):
    cloud = add_cloud(choose_target(scenes.cross()))
    with edit_mode(cloud):
        snap(align="NORMAL")
    assert "vertices have no rotation to align" in capfd.readouterr().out
