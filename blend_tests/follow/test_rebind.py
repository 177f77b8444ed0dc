# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that are bound again after their surface has changed."""

import re

import bmesh
import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming
from limit_surface import ids
from limit_surface.reading import attributes


def rebind(ob: bpy.types.Object, **properties: object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    scenes.activate(ob)
    ob.select_set(True)
    assert bpy.ops.object.limit_rebind(**properties) == {"FINISHED"}


def renumber_faces(mesh: bpy.types.Mesh) -> None:
    """Changes the order of a mesh's quads, and the vertex that each begins with. The surface stays
    the same.
    """
    rng = np.random.default_rng(4)
    order = rng.permutation(len(mesh.polygons))
    first = rng.integers(0, 4, len(order))
    corners = (order[:, None] * 4 + (first[:, None] + np.arange(4)) % 4).ravel()
    vertices = attributes.read(mesh, ids.CORNER_VERTEX)[corners]
    layers = [(layer, attributes.read(mesh, layer.name)[corners]) for layer in mesh.uv_layers]
    mesh.loops.foreach_set("vertex_index", vertices)
    for layer, uv in layers:
        layer.data.foreach_set("uv", uv.ravel())
    mesh.update(calc_edges=True)


def remove_faces(mesh: bpy.types.Mesh, numbers: set[int]) -> None:
    edited = bmesh.new()
    edited.from_mesh(mesh)
    edited.faces.ensure_lookup_table()
    bmesh.ops.delete(edited, geom=[edited.faces[i] for i in numbers], context="FACES")
    edited.to_mesh(mesh)
    edited.free()


def with_map() -> bpy.types.Object:
    ob = deforming("grid with holes")
    scenes.add_uv_map(ob, lambda p: p[:, :2] / 5)
    return ob


@pytest.mark.parametrize("method", ["CLOSEST", "UV"])
def test_other_numbers_of_faces_move_nothing(method):
    ob = with_map()
    hair = scenes.add_hair(ob, tilt=(0.4, 0.2), follow="NODES")
    before, faces = scenes.strands(hair), attributes.read(hair.data, ids.FACE)
    stored_uv = attributes.read(hair.data, ids.SURFACE_UV)
    renumber_faces(ob.data)
    rebind(hair, method=method)
    assert np.mean(attributes.read(hair.data, ids.FACE) != faces) > 0.8
    np.testing.assert_allclose(scenes.strands(hair), before, atol=1e-5)
    np.testing.assert_allclose(attributes.read(hair.data, ids.SURFACE_UV), stored_uv, atol=1e-5)
    for frame in (1, 17, 30):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)


def test_points_keep_their_orientation():
    ob = deforming("grid with holes")
    points = scenes.add_points(ob, follow="NODES")
    names = (ids.POSITION, ids.NORMAL, ids.TANGENT, ids.ROTATION)
    before = [attributes.read(points.data, name) for name in names]
    renumber_faces(ob.data)
    rebind(ob)
    for name, values in zip(names, before, strict=True):
        np.testing.assert_allclose(attributes.read(points.data, name), values, atol=2e-5)
    bpy.context.scene.frame_set(30)
    now = follow_truth.on_surface(ob, points.data).position
    error = np.abs(follow_truth.shown(points, ids.POSITION) - now).max()
    # closest points are found to their own accuracy
    assert error < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)


def test_roots_go_to_the_closest_points_of_a_finer_mesh(capfd):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES")
    points = scenes.add_points(ob, follow="NODES")
    before = scenes.strands(hair)
    root = follow_truth.rest(hair.data).position
    edited = bmesh.new()
    edited.from_mesh(ob.data)
    bmesh.ops.subdivide_edges(edited, edges=edited.edges[:], cuts=1, use_grid_fill=True)
    edited.to_mesh(ob.data)
    edited.free()
    bpy.context.view_layer.update()
    np.testing.assert_allclose(follow_truth.shown_strands(hair), before, atol=1e-6)
    rebind(hair)
    surface = scenes.surface_without_addon(ob)
    matrix = np.array(ob.matrix_world)
    surface.set_positions(scenes.transformed(matrix, surface.positions))
    hits = surface.closest(scenes.transformed(matrix, root))
    now = follow_truth.rest(hair.data).position
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    assert np.abs(scenes.transformed(matrix, now) - hits.position).max() < 4 * bound
    assert np.median(hits.distance) > 1e-3
    # strands keep their length and their angle to the surface
    strands = scenes.strands(hair)
    np.testing.assert_allclose(strands[:, 0], now, atol=1e-5)
    length = np.linalg.norm(strands[:, -1] - strands[:, 0], axis=1)
    np.testing.assert_allclose(
        length, np.linalg.norm(before[:, -1] - before[:, 0], axis=1), rtol=1e-4
    )
    for frame in (9, 30):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)
    # all that follows the surface is bound again with it
    on = follow_truth.on_surface(ob, points.data).position
    assert np.abs(follow_truth.shown(points, ids.POSITION) - on).max() < bound
    both = np.concatenate([hits.distance, hits.distance])
    told = re.search(
        r"moved by ([\d.e-]+) \(median\) and by at most ([\d.e-]+)", capfd.readouterr().out
    )
    assert told
    np.testing.assert_allclose(
        [float(number) for number in told.groups()], [np.median(both), both.max()], rtol=2e-3
    )


def test_rules_change_and_faces_stay():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES")
    before = {name: attributes.read(hair.data, name) for name in (ids.POSITION, ids.UV)}
    ob.modifiers["Subdivision"].boundary_smooth = "PRESERVE_CORNERS"
    bpy.context.scene.frame_set(20)
    with pytest.raises(AssertionError):
        check_hair(ob, hair)
    rebind(hair, method="FACE")
    for name, values in before.items():
        np.testing.assert_array_equal(attributes.read(hair.data, name), values)
    for frame in (20, 30):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)


def selected(data: bpy.types.ID) -> np.ndarray:
    return np.flatnonzero(attributes.read(data, ids.SELECTION))


@pytest.mark.parametrize("method", ["CLOSEST", "UV", "FACE"])
def test_roots_that_cannot_be_kept_stay_and_are_selected(method, capfd):
    ob = with_map()
    hair = scenes.add_hair(ob, follow="NODES")
    points = scenes.add_points(ob, follow="NODES")
    if method == "UV":
        uv = attributes.read(hair.data, ids.SURFACE_UV)
        attributes.write(points.data, ids.SURFACE_UV, "FLOAT2", "POINT", uv)
    before, (faces, places) = scenes.strands(hair), scenes.locations(hair.data)
    removed = {16, 17} if method == "FACE" else {9, 10}
    remove_faces(ob.data, removed)
    bpy.context.scene.frame_set(1)
    rebind(hair, method=method, distance=0.02)
    lost = selected(hair.data)
    gone = np.flatnonzero(np.isin(faces, list(removed)))
    if method == "FACE":
        np.testing.assert_array_equal(lost, gone)
    else:
        # the border of what is left is rounder than the faces that were removed
        middle = gone[np.abs(places[gone] - 0.5).max(axis=1) < 0.25]
        assert len(middle) > 4
        assert set(middle) <= set(lost)
        assert len(lost) < 1.5 * len(gone)
    np.testing.assert_array_equal(scenes.strands(hair)[lost], before[lost])
    np.testing.assert_array_equal(attributes.read(hair.data, ids.FACE)[lost], -1)
    chosen = np.zeros(len(points.data.vertices), bool)
    points.data.vertices.foreach_get("select", chosen)
    np.testing.assert_array_equal(np.flatnonzero(chosen), lost)
    told = capfd.readouterr().out
    assert f"Warning: {2 * len(lost)} strands and points on Holes could not be kept" in told
    bpy.context.scene.frame_set(25)
    shown = follow_truth.shown_strands(hair)
    np.testing.assert_allclose(shown[lost], before[lost], atol=1e-6)
    assert np.abs(np.delete(shown - before, lost, axis=0)).max() > 0.05
    # where the others are
    kept = np.setdiff1d(np.arange(len(before)), lost)
    at = scenes.surface_without_addon(ob).evaluate(
        attributes.read(hair.data, ids.FACE)[kept],
        attributes.read(hair.data, ids.UV)[kept].astype(np.float64),
    )
    error = np.abs(shown[kept, 0] - at.position).max()
    assert error < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    # they are bound where they stand by the next binding at closest points
    rebind(hair)
    np.testing.assert_allclose(follow_truth.shown_strands(hair)[lost], before[lost], atol=1e-5)
    assert np.all(attributes.read(hair.data, ids.TILE) > 0)


def test_new_faces_have_to_be_rebound():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES")
    renumber_faces(ob.data)
    for operator in (bpy.ops.object.limit_follow, bpy.ops.object.limit_points_add):
        scenes.activate(ob)
        with pytest.raises(RuntimeError, match=f"{hair.name} was bound before the faces of Holes"):
            operator()
    rebind(hair)
    scenes.add_points(ob, follow="NODES")


def test_hair_that_does_not_follow_is_bound_to_its_changed_surface():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, tilt=(0.4, 0.2), follow="NODES")
    before = scenes.strands(hair)
    scenes.activate(hair)
    bpy.ops.object.limit_unbind(shape="REST")
    renumber_faces(ob.data)
    rebind(hair)
    np.testing.assert_allclose(scenes.strands(hair), before, atol=1e-5)
    for frame in (1, 30):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)


def test_undo_gives_everything_back():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES")
    before, faces = scenes.strands(hair), attributes.read(hair.data, ids.FACE)
    bpy.ops.ed.undo_push(message="before")
    renumber_faces(ob.data)
    rebind(hair)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    ob, hair = bpy.data.objects["Holes"], bpy.data.objects[ids.HAIR_OBJECT]
    np.testing.assert_array_equal(scenes.strands(hair), before)
    np.testing.assert_array_equal(attributes.read(hair.data, ids.FACE), faces)
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)


def refused(match: str, ob: bpy.types.Object, **properties: object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    scenes.activate(ob)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_rebind(**properties)
    assert scenes.file_contents() == before


def test_refusals():
    ob = deforming("grid with holes")
    refused("Select a surface that something follows, or what follows it", ob)
    hair = scenes.add_hair(ob, follow="NODES")
    refused("does not store the UVs of its roots", hair, method="UV")
    scenes.add_uv_map(ob, lambda p: p[:, :2])
    attributes.write(
        hair.data, ids.SURFACE_UV, "FLOAT2", "CURVE", np.zeros((len(hair.data.curves), 2))
    )
    hair.data.surface_uv_map = "Gone"
    refused("the modifiers remove the UV map Gone", hair, method="UV")
    points = scenes.add_points(ob, follow="NODES")
    points.shape_key_add(name="Basis")
    refused("has shape keys, which would stay behind", points)
    bpy.ops.object.mode_set(mode="EDIT")
    refused_mode = pytest.raises(RuntimeError, match="Only available in Object Mode")
    with refused_mode:
        bpy.ops.object.limit_rebind()
    bpy.ops.object.mode_set(mode="OBJECT")
    remove_faces(ob.data, set(range(len(ob.data.polygons))))
    refused("has no faces", ob)
