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
from limit_surface.placing import seals
from limit_surface.reading import attributes
from live_scenes import follow
from mathutils import Matrix


def garment() -> tuple[bpy.types.Object, bpy.types.Object]:
    body = deforming("cross")
    body.matrix_world = Matrix()  # stretched, another point would be the closest in the world
    properties = {"levels": 1, "follow": "NONE", "store_locations": True}
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


def test_they_stay_still_live_until_the_operator_is_run():
    _, ob = garment()
    follow(ob)
    before = len(ob.data.vertices)
    subdivide(ob)
    shown = follow_truth.shown(ob, ids.POSITION).copy()
    bpy.context.scene.frame_set(30)
    moved = np.abs(follow_truth.shown(ob, ids.POSITION) - shown).max(axis=1)
    assert moved[:before].max() > 0.1
    assert moved[before:].max() == 0


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


def test_averages_of_seals_are_no_seals():
    ob = scenes.flat_grid(40)
    count = len(ob.data.vertices)
    seals.seal(ob.data, np.arange(count))
    values = attributes.read(ob.data, ids.SEAL).astype(np.float32)
    assert not seals.are_broken(ob.data).any()
    assert (values != 0).all()
    random = np.random.default_rng(5)
    found = 0
    for _ in range(200):
        one, other = random.integers(count, size=(2, count))
        share = random.choice([0.25, 0.5, 0.75], size=count).astype(np.float32)
        mixed = np.rint(values[one] * share + values[other] * (1 - share)).astype(np.int32)
        attributes.write(ob.data, ids.SEAL, "INT", "POINT", mixed)
        found += int(seals.are_broken(ob.data).sum())
    tried = 200 * count
    assert found > tried - 20 - tried / count * 2  # each 65,536th passes, and averages with itself


def test_meshes_of_earlier_files_keep_their_places():
    body, ob = garment()
    follow(ob, mode="NODES")
    ob.data.attributes.remove(ob.data.attributes[ids.SEAL])
    assert seals.are_broken(ob.data) is None
    follow(ob, mode="LIVE")
    assert not seals.are_broken(ob.data).any()
    bpy.context.scene.frame_set(30)
    assert distances(body, ob).max() < 1e-5
