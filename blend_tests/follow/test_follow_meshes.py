# SPDX-License-Identifier: GPL-3.0-or-later
"""Decals and limit meshes that follow a deforming surface."""

import bmesh
import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.placing.followers import live_modifier_of, modifier_of
from limit_surface.reading import attributes

FRAMES = ((1, 0.0), (13, 0.5), (30, 0.0))
#: Largest difference of normals where the normal is not one of single precision's worst cases
NORMAL_BOUND = 1e-4
#: At rounded corners of one face du and dv are almost parallel.
CORNER_NORMAL_BOUND = 2e-2


def decal(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    scenes.activate(ob)
    bpy.data.images.new("Shown", 64, 64)
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    empty.empty_display_size = 3
    empty.location = (2.5, 2, 5) if ob.name == "Holes" else (0, 0, 5)
    bpy.context.view_layer.update()
    settings = {"mode": "DECAL", "source": "PLANAR", "image": "Shown", "decal_resolution": 24}
    made = bpy.ops.object.limit_project_image(**settings | {"empty": "Empty"} | properties)
    assert made == {"FINISHED"}
    return bpy.context.active_object


def limit_mesh(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    scenes.activate(ob)
    assert bpy.ops.object.limit_mesh(**{"levels": 2} | properties) == {"FINISHED"}
    return bpy.context.active_object


def follows(ob: bpy.types.Object) -> bool:
    return modifier_of(ob) is not None


def shown_normals(ob: bpy.types.Object) -> np.ndarray:
    mesh = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    normals = np.empty((len(mesh.loops), 3), np.float32)
    mesh.corner_normals.foreach_get("vector", normals.ravel())
    return normals


def almost_parallel(ob: bpy.types.Object, made: bpy.types.Object) -> np.ndarray:
    """Tells for each vertex whether du and dv are."""
    at = scenes.surface_without_addon(ob).evaluate(*scenes.locations(made.data), derivatives=1)
    product = np.linalg.norm(np.cross(at.du, at.dv), axis=1)
    return product < 1e-3 * np.linalg.norm(at.du, axis=1) * np.linalg.norm(at.dv, axis=1)


def has_normals(ob: bpy.types.Object, made: bpy.types.Object) -> np.ndarray:
    """Tells for each vertex whether the normal has a limit there, if it is a vertex of the cage."""
    face, uv = scenes.locations(made.data)
    at_vertex = np.where(np.abs(uv - np.rint(uv)) < 1e-6, np.rint(uv), uv)
    at = scenes.surface_without_addon(ob).evaluate(face, at_vertex, derivatives=1)
    return np.isfinite(at.normal).all(axis=1)


def check(ob: bpy.types.Object, made: bpy.types.Object) -> None:
    at_rest = ids.LIVE_REST if live_modifier_of(made) else ids.POSITION
    positions = attributes.read(made.data, at_rest).astype(np.float64)[:, None]
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    corners = attributes.read(made.data, ids.CORNER_VERTEX)
    is_corner, has_normal = almost_parallel(ob, made)[corners], has_normals(ob, made)[corners]
    before = follow_truth.rest(made.data).frame[corners]
    normals = np.einsum("nji,nj->ni", before, shown_normals(made))
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        now = follow_truth.on_surface(ob, made.data)
        expected = follow_truth.moved(positions, made.data, now)[:, 0]
        assert np.abs(follow_truth.shown(made, ids.POSITION) - expected).max() < bound
        turned = np.einsum("nij,nj->ni", now.frame[corners], normals)
        error = np.abs(shown_normals(made) - turned).max(axis=1)
        if bpy.app.version < (4, 5):  # normals are angles there, and turn with the polygons
            continue
        assert error[~is_corner & has_normal].max() < NORMAL_BOUND
        assert error[has_normal].max() < CORNER_NORMAL_BOUND


@pytest.mark.parametrize("scene", ["cross", "grid with holes"])
def test_decals_follow_at_their_distance(scene):
    ob = deforming(scene)
    ob.matrix_world.identity()
    made = decal(ob, decal_offset=0.02)
    assert follows(made)
    check(ob, made)


@pytest.mark.every(3)
@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("scene", scenes.SCENES)
def test_limit_meshes_follow(scene, mirrored):
    ob = deforming(scene, mirrored)
    made = limit_mesh(ob)
    assert follows(made)
    check(ob, made)


def test_a_limit_mesh_is_the_one_of_each_frame():
    """The limit mesh that follows is the limit mesh that is made in that frame."""
    ob = deforming("cross")
    made = limit_mesh(ob)
    bpy.context.scene.frame_set(30)
    anew = limit_mesh(ob, follow="NONE")
    moved = follow_truth.shown(made, ids.POSITION)
    assert np.abs(moved - attributes.read(made.data, ids.POSITION)).max() > 0.1
    expected = attributes.read(anew.data, ids.POSITION)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    assert np.abs(moved - expected).max() < bound


def make_live(made: bpy.types.Object) -> None:
    for ob in bpy.context.selected_objects:
        ob.select_set(False)
    scenes.activate(made)
    made.select_set(True)
    assert bpy.ops.object.limit_follow(mode="LIVE") == {"FINISHED"}
    assert modifier_of(made) is None
    assert live_modifier_of(made)


@pytest.mark.every(3)
@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("scene", scenes.SCENES)
def test_limit_meshes_follow_live(scene, mirrored):
    ob = deforming(scene, mirrored)
    made = limit_mesh(ob)
    make_live(made)
    check(ob, made)


def test_decals_follow_live():
    ob = deforming("grid with holes")
    ob.matrix_world.identity()
    made = decal(ob, decal_offset=0.02, follow="NONE")
    make_live(made)
    check(ob, made)


@pytest.mark.skipif(bpy.app.version < (4, 5), reason="normals are angles before Blender 4.5")
def test_normals_go_back_to_rest_or_stay():
    ob = deforming("cross")
    made = limit_mesh(ob)
    rest = attributes.read(made.data, ids.CUSTOM_NORMAL)
    make_live(made)
    bpy.context.scene.frame_set(30)
    shown = attributes.read(made.data, ids.CUSTOM_NORMAL)
    assert np.abs(shown - rest).max() > 0.1
    bpy.ops.ed.undo_push(message="live")
    assert bpy.ops.object.limit_unbind(shape="SHOWN") == {"FINISHED"}
    np.testing.assert_array_equal(attributes.read(made.data, ids.CUSTOM_NORMAL), shown)
    assert not [a.name for a in made.data.attributes if a.name.startswith(ids.LIVE_REST)]
    make_live(made)
    bpy.context.scene.frame_set(1)
    np.testing.assert_allclose(attributes.read(made.data, ids.CUSTOM_NORMAL), rest, atol=2e-4)
    bpy.context.scene.frame_set(30)
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    np.testing.assert_allclose(attributes.read(made.data, ids.CUSTOM_NORMAL), shown, atol=1e-6)


@pytest.mark.skipif(bpy.app.version < (4, 5), reason="normals are angles before Blender 4.5")
def test_faces_of_the_mesh_itself_may_change_while_it_follows_live():
    ob = deforming("grid with holes")
    ob.matrix_world.identity()
    made = limit_mesh(ob)
    make_live(made)
    bpy.context.scene.frame_set(30)
    edited = bmesh.new()
    edited.from_mesh(made.data)
    edited.faces.ensure_lookup_table()
    bmesh.ops.delete(edited, geom=edited.faces[:20], context="FACES_ONLY")
    edited.to_mesh(made.data)
    edited.free()
    bpy.context.scene.frame_set(1)
    check(ob, made)


def test_what_cannot_follow_live_is_refused():
    ob = deforming("cross")
    made = limit_mesh(ob)
    made.shape_key_add(name="Basis")
    scenes.activate(made)
    with pytest.raises(RuntimeError, match="has shape keys. Live following cannot move these"):
        bpy.ops.object.limit_follow(mode="LIVE")
    assert follows(made)


@pytest.mark.parametrize("make", [decal, limit_mesh])
def test_they_follow_later(make):
    ob = deforming("cross")
    ob.matrix_world.identity()
    stored = {"store_locations": True} if make == limit_mesh else {}
    made = make(ob, follow="NONE", **stored)
    assert not follows(made)
    bpy.context.scene.frame_set(9)  # things at rest in another frame are carried to this one
    scenes.activate(made)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        positions = attributes.read(made.data, ids.POSITION).astype(np.float64)[:, None]
        now = follow_truth.on_surface(ob, made.data)
        expected = follow_truth.moved(positions, made.data, now)[:, 0]
        assert np.abs(follow_truth.shown(made, ids.POSITION) - expected).max() < bound


@pytest.mark.parametrize("make", [decal, limit_mesh])
def test_they_do_not_follow_a_mesh_that_cannot_deform(make):
    ob = scenes.cross()
    scenes.add_subsurf(ob)
    made = make(ob)
    assert not follows(made)
    assert ids.TILES_TABLE not in bpy.data.objects
    assert [m.type for m in ob.modifiers] == ["SUBSURF"]


def test_a_refused_decal_leaves_the_file_as_it_was():
    ob = deforming("cross")
    bpy.data.images.new("Shown", 64, 64)
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    empty.location = (50, 0, 5)
    scenes.activate(ob)
    contents = scenes.file_contents()
    settings = {"mode": "DECAL", "source": "PLANAR", "image": "Shown", "empty": "Empty"}
    with pytest.raises(RuntimeError, match="no part of the image Shown falls on the surface"):
        bpy.ops.object.limit_project_image(**settings)
    assert scenes.file_contents() == contents


def rough_mesh(ob: bpy.types.Object) -> bpy.types.Object:
    return limit_mesh(ob, exact_normals=False)


@pytest.mark.parametrize("make", [decal, limit_mesh, rough_mesh])
def test_unbound_meshes_keep_positions_and_normals(make):
    ob = deforming("cross")
    ob.matrix_world.identity()
    made = make(ob)
    bpy.context.scene.frame_set(30)
    shown, normals = follow_truth.shown(made, ids.POSITION), shown_normals(made)
    scenes.activate(made)
    assert bpy.ops.object.limit_unbind(shape="SHOWN") == {"FINISHED"}
    assert not made.modifiers
    np.testing.assert_array_equal(follow_truth.shown(made, ids.POSITION), shown)
    np.testing.assert_allclose(shown_normals(made), normals, atol=1e-6)


def test_lost_vertices_are_selected_alone_where_blender_stored_the_selection_wrongly():
    ob = deforming("cross")
    made = limit_mesh(ob)
    face = attributes.read(made.data, ids.FACE)
    edited = bmesh.new()
    edited.from_mesh(ob.data)
    bmesh.ops.delete(edited, geom=list(edited.faces)[:1], context="FACES_ONLY")
    edited.to_mesh(ob.data)
    edited.free()
    scenes.spoil_edge_selection(made.data)
    scenes.activate(made)
    assert bpy.ops.object.limit_rebind(method="FACE") == {"FINISHED"}
    lost = [vertex.select for vertex in made.data.vertices]
    np.testing.assert_array_equal(lost, attributes.read(made.data, ids.FACE) < 0)
    assert 0 < np.sum(lost) < len(face)
    assert not any(each.select for each in (*made.data.edges, *made.data.polygons))
