# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that edits add to meshes that follow. Blender gives them averages of what their
neighbours store about their places, which are no places of theirs.
"""

import bpy
import follow_truth
import followed_places
import numpy as np
import pytest
import scenes
from follow_scenes import deforming, look
from limit_surface import ids
from limit_surface.placing import live_kept, seals
from limit_surface.reading import attributes
from live_scenes import follow
from mathutils import Matrix


def garment(levels: int = 1) -> tuple[bpy.types.Object, bpy.types.Object]:
    body = deforming("cross")
    body.matrix_world = Matrix()  # stretched, another point would be the closest in the world
    properties = {"levels": levels, "follow": "NONE", "store_locations": True}
    assert bpy.ops.object.limit_mesh(**properties) == {"FINISHED"}
    return body, bpy.context.object


def subdivide(ob: bpy.types.Object) -> None:
    scenes.activate(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")


def distances(body: bpy.types.Object, ob: bpy.types.Object) -> np.ndarray:
    """Returns the distances of what is shown from the surface, as it is now."""
    shown = follow_truth.shown(ob, ids.POSITION).astype(np.float64)
    surface = scenes.surface_without_addon(body)
    to_body = follow_truth.relation(ob, body)
    return surface.closest(scenes.transformed(to_body, shown)).distance


@pytest.mark.parametrize("mode", ["NODES", "LIVE"])
@pytest.mark.parametrize("remedy", ["follow", "rebind"])
def test_added_vertices_are_bound_where_they_are(mode, remedy):
    body, ob = garment()
    follow(ob, mode=mode)
    before = len(ob.data.vertices)
    subdivide(ob)
    broken = seals.are_broken(ob.data)
    assert broken is not None
    np.testing.assert_array_equal(np.flatnonzero(broken), np.arange(before, len(ob.data.vertices)))
    if remedy == "follow":
        follow(ob, mode=mode)
    else:
        assert bpy.ops.object.limit_rebind(method="CLOSEST") == {"FINISHED"}
    at_rest = distances(body, ob)
    assert 0.01 < at_rest.max() < 0.1  # the middles of edges
    for frame in (30, 12, 1):
        bpy.context.scene.frame_set(frame)
        assert (distances(body, ob) <= at_rest + 1e-5).all()
        assert not followed_places.misplaced()


def test_they_are_bound_where_nothing_followed_when_they_were_added():
    body, ob = garment()
    subdivide(ob)
    at_rest = distances(body, ob)
    follow(ob, mode="LIVE")
    bpy.context.scene.frame_set(30)
    assert (distances(body, ob) <= at_rest + 1e-5).all()


def off_middles(ob: bpy.types.Object, count: int) -> np.ndarray:
    """Returns how far vertices that were added on edges are shown from the middles between the ends
    of these edges, which are among the first `count` vertices.
    """
    ends = attributes.read(ob.data, ids.EDGE_VERTICES)
    ends = np.sort(ends[(ends < count).sum(axis=1) == 1], axis=1)
    ends = ends[np.argsort(ends[:, 1], kind="stable")].reshape(-1, 2, 2)
    assert (ends[:, 0, 1] == ends[:, 1, 1]).all()
    shown = follow_truth.shown(ob, ids.POSITION)
    return np.linalg.norm(shown[ends[:, 0, 1]] - shown[ends[:, :, 0]].mean(axis=1), axis=1)


@pytest.mark.parametrize("mode", ["NODES", "LIVE"])
@pytest.mark.parametrize("frame", [1, 20])
def test_the_frame_in_which_they_are_bound_does_not_matter(mode, frame):
    _, ob = garment(levels=3)
    follow(ob, mode=mode)
    before = len(ob.data.vertices)
    subdivide(ob)
    bpy.context.scene.frame_set(frame)
    follow(ob, mode=mode)
    # live, nothing moves in the frame in which they are bound, which is best that of the edit
    bound = 0.06 if mode == "LIVE" and frame != 1 else 0.03
    for shown_in in (1, 12, 30):
        bpy.context.scene.frame_set(shown_in)
        assert off_middles(ob, before).max() < bound
        assert not followed_places.misplaced()


@pytest.mark.parametrize("frame", [1, 20])
def test_nothing_moves_when_live_ones_are_bound(frame):
    _, ob = garment()
    follow(ob)
    bpy.context.scene.frame_set(frame)
    subdivide(ob)
    shown = follow_truth.shown(ob, ids.POSITION).copy()
    follow(ob)
    assert np.abs(follow_truth.shown(ob, ids.POSITION) - shown).max() < 1e-5


@pytest.mark.parametrize("mode", ["NODES", "LIVE"])
def test_changed_faces_are_refused_as_without_added_vertices(mode):
    body, ob = garment()
    follow(ob, mode=mode)
    bpy.ops.object.select_all(action="DESELECT")
    subdivide(body)
    subdivide(ob)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="was bound before the faces of Cross changed"):
        follow(ob, mode=mode)
    assert scenes.file_contents() == before
    if mode == "NODES":
        assert look(body)[0][1] == ids.REBIND


@pytest.mark.parametrize("mode", ["NODES", "LIVE"])
def test_they_move_with_the_others_when_all_are_bound_to_a_changed_surface(mode):
    body, ob = garment(levels=3)
    follow(ob, mode=mode)
    before = len(ob.data.vertices)
    subdivide(ob)
    for key in body.data.shape_keys.key_blocks:
        for point in key.data:
            point.co.z += 0.05
    body.data.update_tag()
    bpy.context.view_layer.update()
    scenes.activate(ob)
    assert bpy.ops.object.limit_rebind(method="CLOSEST") == {"FINISHED"}
    for frame in (1, 20):
        bpy.context.scene.frame_set(frame)
        assert off_middles(ob, before).max() < 0.03


def test_seals_tell_places_not_numbers():
    """Two meshes of the same topology may be joined, and vertices of the same number connected."""
    _, ob = garment()
    before = attributes.read(ob.data, ids.SEAL).copy()
    face = attributes.read(ob.data, ids.FACE)
    attributes.write(ob.data, ids.FACE, "INT", "POINT", face + 20)
    seals.seal(ob.data, np.arange(len(face)))
    assert (attributes.read(ob.data, ids.SEAL) != before).any(axis=1).all()


def test_unbinding_as_shown_is_refused():
    _, ob = garment()
    follow(ob, mode="NODES")
    subdivide(ob)
    with pytest.raises(
        RuntimeError, match="72 vertices of Limit Mesh were added since it was bound"
    ):
        bpy.ops.object.limit_unbind(shape="SHOWN")
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}


def test_what_was_added_while_the_body_is_bent_is_bound_there():
    """In live mode, Edit Mode shows the mesh of this frame. The middles of edges of the bent mesh
    are farther from the surface than those of the mesh at rest.
    """
    _, ob = garment(levels=3)
    follow(ob)
    bpy.context.scene.frame_set(20)
    before = len(ob.data.vertices)
    subdivide(ob)
    for bound in (False, True):
        if bound:
            follow(ob)
        for frame in (30, 1, 20):
            bpy.context.scene.frame_set(frame)
            assert off_middles(ob, before).max() < 0.06
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    assert off_middles(ob, before).max() < 0.06


def test_live_ones_follow_with_their_neighbours_until_they_are_bound():
    _, ob = garment(levels=3)
    follow(ob)
    before = len(ob.data.vertices)
    subdivide(ob)
    bpy.context.scene.frame_set(30)
    assert off_middles(ob, before).max() < 0.06
    added = len(ob.data.vertices) - before
    text = f"{added:,} vertices of Limit Mesh were added and have no places: "
    assert live_kept.trouble(ob).startswith(text)
    assert live_kept.remedy(ob) == ids.FOLLOW
    follow(ob)
    assert (live_kept.trouble(ob), live_kept.remedy(ob)) == ("", "")


def test_the_panel_names_them():
    body, ob = garment()
    follow(ob, mode="NODES")
    assert look(body) == []
    subdivide(ob)
    assert look(body) == [("72 vertices of Limit Mesh were added since it was bound", ids.FOLLOW)]
    follow(ob, mode="NODES")
    assert look(body) == []


def test_copies_of_vertices_keep_their_places():
    body, ob = garment()
    follow(ob, mode="NODES")
    scenes.activate(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.extrude_region_move(TRANSFORM_OT_translate={"value": (0, 0, 0.1)})
    bpy.ops.object.mode_set(mode="OBJECT")
    assert not seals.are_broken(ob.data).any()
    assert look(body) == []


def with_places(ob: bpy.types.Object) -> bpy.types.Object:
    count, random = len(ob.data.vertices), np.random.default_rng(3)
    for name, kind, width in (
        (ids.UV, "FLOAT2", 2),
        (ids.REST_ROOT, "FLOAT_VECTOR", 3),
        (ids.REST_ROTATION, "QUATERNION", 4),
    ):
        attributes.write(ob.data, name, kind, "POINT", random.random((count, width)))
    attributes.write(ob.data, ids.FACE, "INT", "POINT", np.arange(count) // 4)
    return ob


def test_averages_of_seals_are_no_seals():
    ob = with_places(scenes.flat_grid(200))
    count = len(ob.data.vertices)
    seals.seal(ob.data, np.arange(count))
    values = attributes.read(ob.data, ids.SEAL)
    assert not seals.are_broken(ob.data).any()
    assert values.all()
    random = np.random.default_rng(5)
    for shares in ((0.5, 0.5), (0.25, 0.75), (1 / 3, 2 / 3), (0.2, 0.3, 0.5), (0.25,) * 4):
        mixed = np.zeros_like(values)
        for share in shares:
            mixed += np.float32(share) * values[random.permutation(count)]
        attributes.write(ob.data, ids.SEAL, seals.KIND, "POINT", mixed)
        assert seals.are_broken(ob.data).sum() > count - 20  # of some all sources are the same


@pytest.mark.parametrize("spoilt", [np.nan, np.inf, -1.0, 1e30])
def test_any_numbers_are_read(spoilt):
    ob = with_places(scenes.cross())
    seals.seal(ob.data, np.arange(len(ob.data.vertices)))
    values = attributes.read(ob.data, ids.SEAL)
    values[2, 0] = spoilt
    attributes.write(ob.data, ids.SEAL, seals.KIND, "POINT", values)
    assert np.flatnonzero(seals.are_broken(ob.data)).tolist() == [2]


def test_a_mesh_without_vertices_is_sealed():
    ob = with_places(scenes.add_mesh("Empty", [], []))
    seals.seal(ob.data, np.arange(0))
    assert seals.are_broken(ob.data).shape == (0,)
    assert seals.nearest_placed(ob.data, np.zeros(0, bool)).shape == (0,)


def test_a_vertex_group_of_that_name_is_refused():
    _, ob = garment()
    ob.data.attributes.remove(ob.data.attributes[ids.SEAL])
    ob.vertex_groups.new(name=ids.SEAL)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="has a vertex group limit_seal"):
        follow(ob)
    assert scenes.file_contents() == before


def test_meshes_of_earlier_files_keep_their_places():
    body, ob = garment()
    follow(ob, mode="NODES")
    ob.data.attributes.remove(ob.data.attributes[ids.SEAL])
    assert seals.are_broken(ob.data) is None
    follow(ob, mode="LIVE")
    assert not seals.are_broken(ob.data).any()
    ob.data.attributes.remove(ob.data.attributes[ids.SEAL])
    follow(ob, mode="LIVE")  # it follows live already
    assert not seals.are_broken(ob.data).any()
    bpy.context.scene.frame_set(30)
    assert distances(body, ob).max() < 1e-5


def test_long_chains_of_added_vertices():
    """Only one end has a place. Where each step looks at all edges this takes minutes."""
    count = 100_000
    mesh = bpy.data.meshes.new("Chain")
    mesh.vertices.add(count)
    mesh.edges.add(count - 1)
    ends = np.stack([np.arange(count - 1), np.arange(1, count)], axis=1).astype(np.int32)
    mesh.edges.foreach_set("vertices", ends.ravel())
    has_place = np.arange(count) == 0
    assert (seals.nearest_placed(mesh, has_place) == 0).all()
