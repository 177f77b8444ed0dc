# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points that follow a deforming surface, by Geometry Nodes and live."""

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import FRAMES, deforming
from limit_surface import ids
from limit_surface.reading import attributes
from live_scenes import animate_creases, follow
from mathutils import Matrix

MODES = ("NODES", "LIVE")
TWELVE_FRAMES = [(frame, subframe) for frame in (1, 4, 9, 14, 21, 30) for subframe in (0.0, 0.375)]


@pytest.mark.every(3)
@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("scene", scenes.SCENES)
def test_strands_follow(scene, mirrored, mode):
    ob = deforming(scene, mirrored)
    hair = scenes.add_hair(ob, per_side=3, tilt=(0.4, 0.2), follow="NONE")
    at_rest = follow_truth.AtRest.read(ob, hair)
    follow(hair, mode=mode)
    held = ids.LIVE_REST if mode == "LIVE" else ids.POSITION
    np.testing.assert_array_equal(attributes.read(hair.data, held), at_rest.points.reshape(-1, 3))
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        at_rest.check(ob, hair)


@pytest.mark.every(3)
@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("scene", scenes.SCENES)
def test_points_follow_with_their_frames(scene, mode):
    ob = deforming(scene)
    points = scenes.add_points(ob, per_side=3, follow="NONE")
    follow(points, mode=mode)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        now = follow_truth.on_surface(ob, points.data)
        assert np.abs(follow_truth.shown(points, ids.POSITION) - now.position).max() < bound
        for name, column in ((ids.TANGENT, 0), (ids.NORMAL, 2)):
            error = np.abs(follow_truth.shown(points, name) - now.frame[:, :, column]).max()
            assert error < follow_truth.FRAME_BOUND
        turned = follow_truth.matrices(follow_truth.shown(points, ids.ROTATION))
        assert np.abs(turned - now.frame).max() < follow_truth.FRAME_BOUND


@pytest.mark.parametrize("mode", MODES)
def test_hair_of_another_transform_follows(mode):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NONE")
    before = follow_truth.AtRest.read(ob, hair)
    hair.parent = None
    hair.matrix_world = Matrix.Translation((1, 2, 3)) @ Matrix.Diagonal((0.5, 0.7, -0.9, 1))
    follow(hair, mode=mode)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        before.check(ob, hair)


def crease(ob: bpy.types.Object, name: str, domain: str) -> None:
    count = len(ob.data.edges if domain == "EDGE" else ob.data.vertices)
    rng = np.random.default_rng(6)
    values = np.where(rng.random(count) < 0.4, rng.random(count), 0)
    values[:: count // 3] = 1
    attributes.write(ob.data, name, "FLOAT", domain, values.astype(np.float32))
    ob.data.update_tag()
    bpy.context.view_layer.update()


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(
    ("name", "domain"), [(ids.EDGE_CREASE, "EDGE"), (ids.VERTEX_CREASE, "POINT")]
)
def test_strands_on_creased_meshes_follow(name, domain, mode):
    ob = deforming("grid with holes")
    smooth = scenes.surface_without_addon(ob).area()
    crease(ob, name, domain)
    assert abs(scenes.surface_without_addon(ob).area() - smooth) > 1e-3
    hair = scenes.add_hair(ob, per_side=3, tilt=(0.4, 0.2), follow="NONE")
    at_rest = follow_truth.AtRest.read(ob, hair)
    follow(hair, mode=mode)
    for frame, subframe in TWELVE_FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        at_rest.check(ob, hair)


def test_strands_follow_animated_creases_of_a_deforming_mesh():
    ob = scenes.grid_with_holes()
    follow_truth.animate(ob)
    animate_creases(ob)
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, per_side=3, tilt=(0.4, 0.2), follow="NONE")
    at_rest = follow_truth.AtRest.read(ob, hair)
    follow(hair)
    areas = set()
    for frame, subframe in TWELVE_FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        at_rest.check(ob, hair)
        areas.add(round(scenes.surface_without_addon(ob).area(), 4))
    assert len(areas) == len(TWELVE_FRAMES)


@pytest.mark.parametrize("ways", [["LIVE"], ["LIVE", "NODES"]])
def test_the_surface_alone_restores_everything_in_its_own_way(ways):
    ob = deforming("cross")
    things = [scenes.add_hair(ob, follow=way) for way in ways]
    before = [[modifier.name for modifier in thing.modifiers] for thing in things]
    ob.modifiers.remove(ob.modifiers[ids.CAPTURE_GROUP])
    bpy.ops.object.select_all(action="DESELECT")
    scenes.activate(ob)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    assert ids.CAPTURE_GROUP in ob.modifiers
    assert [[modifier.name for modifier in thing.modifiers] for thing in things] == before
