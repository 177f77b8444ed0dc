# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points that follow a deforming surface live."""

import bpy
import follow_truth
import live_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import live_attributes, live_kept, live_surface
from limit_surface.reading import attributes
from live_scenes import FRAMES, check_hair, deforming, follow
from mathutils import Matrix

OTHER_PLACE = Matrix.Translation((1, 2, 3)) @ Matrix.Diagonal((0.5, 0.7, -0.9, 1))


def test_hair_follows_when_an_object_moves():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    hair.parent = None
    follow(hair)
    for moved in (ob, hair):
        moved.matrix_world = OTHER_PLACE @ moved.matrix_world
        bpy.context.view_layer.update()
        check_hair(ob, hair)


def test_strands_follow_an_armature():
    ob = live_scenes.with_armature("grid with holes")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        check_hair(ob, hair)
    bone = bpy.data.objects["Rig"].pose.bones[0]
    bone.rotation_euler[1] += 0.3  # without a key, as in posing
    bpy.context.view_layer.update()
    check_hair(ob, hair)


@pytest.mark.skipif(bpy.app.version < (4, 5), reason="Blender gives only the subdivided mesh")
def test_the_surface_is_not_subdivided_for_reading():
    ob = deforming("cross")
    follow(scenes.add_hair(ob, follow="NONE"))
    ob.modifiers[-1].levels = 2
    bpy.context.view_layer.update()
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    _geometry, mesh = live_surface.least_subdivided(shown)
    assert len(mesh.vertices) == len(ob.data.vertices) < len(shown.data.vertices)
    assert ids.CAGE_POSITION in mesh.attributes


def test_a_frame_depends_on_nothing_but_itself():
    ob = deforming("mixed polygons")
    hair, points = scenes.add_hair(ob, follow="NONE"), scenes.add_points(ob, follow="NONE")
    follow(hair, points)

    def shown(frame):
        bpy.context.scene.frame_set(frame)
        return [follow_truth.shown(thing, ids.POSITION).tobytes() for thing in (hair, points)]

    forwards = {frame: shown(frame) for frame in range(1, 13)}
    live_kept.forget()
    for frame in (12, 3, 7, 1, 11):
        assert shown(frame) == forwards[frame]
    assert len({tuple(bits) for bits in forwards.values()}) == 12


def test_irregular_faces_are_followed_without_posing_the_surface():
    ob = deforming("mixed polygons")
    hair, points = scenes.add_hair(ob, follow="NONE"), scenes.add_points(ob, follow="NONE")
    follow(hair, points)
    kept, poses = live_kept.known(ob), []
    for frame in range(2, 31):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)
        poses.append(kept.limit.positions.tobytes())
    # The first frames are shown on the posed surface, and all later ones without it.
    assert len(set(poses[:10])) == 10
    assert len(set(poses[15:])) == 1
    assert np.abs(kept.pose.positions - kept.limit.positions).max() > 0.01


def test_the_bounding_box_follows():
    ob = deforming("cross")
    hair, points = scenes.add_hair(ob, follow="NONE"), scenes.add_points(ob, follow="NONE")
    follow(hair, points)
    for thing in (hair, points):
        for frame in (30, 1):
            bpy.context.scene.frame_set(frame)
            shown = follow_truth.shown(thing, ids.POSITION)
            box = np.array(thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).bound_box)
            assert (box.min(axis=0) <= shown.min(axis=0) + 1e-5).all()
            assert (box.max(axis=0) >= shown.max(axis=0) - 1e-5).all()
            assert np.ptp(box, axis=0).max() < 1.5 * np.ptp(shown, axis=0).max()


def test_a_scene_property_switches_it_off():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    before = scenes.strands(hair).copy()
    bpy.context.scene.limit_live = False
    bpy.context.scene.frame_set(30)
    np.testing.assert_array_equal(scenes.strands(hair), before)
    bpy.context.scene.limit_live = True
    bpy.context.view_layer.update()
    check_hair(ob, hair)


def test_creases_that_are_animated_are_followed():
    ob = scenes.SCENES["grid with holes"]()
    live_scenes.animate_creases(ob)
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    shapes = set()
    for frame in (1, 10, 30, 10):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)
        shapes.add(scenes.strands(hair).tobytes())
    assert len(shapes) == 3


def test_topology_that_changes_behind_the_faces_is_followed():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    mirror = ob.modifiers.new("Mirror", "MIRROR")
    mirror.use_mirror_merge = False
    ob.modifiers.move(ob.modifiers.find(mirror.name), 0)
    for frame in (1, 30):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)


def test_faces_that_vanish_leave_things_and_name_the_reason():
    ob = deforming("monkey")
    hair = scenes.add_hair(ob, per_side=1, follow="NONE")
    follow(hair)
    before = scenes.strands(hair).copy()
    ob.data.clear_geometry()
    ob.data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    bpy.context.scene.frame_set(20)
    np.testing.assert_array_equal(scenes.strands(hair), before)
    reason = f"The faces of {ob.name} have changed since {hair.name} was bound"
    assert live_kept.trouble(hair) == reason


def test_the_strand_whose_root_is_no_place_is_named():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, per_side=1, follow="NONE")
    follow(hair)
    root = attributes.read(hair.data, ids.REST_ROOT)
    root[3] = np.nan
    attributes.write(hair.data, ids.REST_ROOT, "FLOAT_VECTOR", "CURVE", root)
    live_kept.forget()
    bpy.context.scene.frame_set(20)
    assert live_kept.trouble(hair).startswith("Strand 3 of Limit Hair: Rest Roots is (nan")


def test_a_surface_without_subdivision_is_followed():
    ob = scenes.SCENES["cross"]()
    follow_truth.animate(ob)
    ob.modifiers.clear()
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)


def test_nothing_is_written_where_nothing_changes():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    evaluated = []

    def count(_scene, depsgraph):
        evaluated.append({update.id.name for update in depsgraph.updates})

    bpy.app.handlers.depsgraph_update_post.append(count)
    try:
        ob.data.update_tag()
        bpy.context.view_layer.update()
        once = len(evaluated)
        for _ in range(3):
            bpy.context.view_layer.update()
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(count)
    assert once == 1
    assert len(evaluated) - once <= 3
    assert not any(hair.data.name in names for names in evaluated[1:])


def test_the_private_scene_is_left_alone():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    scenes_before, objects_before = len(bpy.data.scenes), len(bpy.data.objects)
    live_kept.forget()
    bpy.context.scene.frame_set(12)
    assert (len(bpy.data.scenes), len(bpy.data.objects)) == (scenes_before, objects_before)


def test_attributes_that_are_missing_are_named():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    hair.data.attributes.remove(hair.data.attributes[ids.LIVE_REST])
    before = scenes.strands(hair).copy()
    bpy.context.scene.frame_set(30)
    np.testing.assert_array_equal(scenes.strands(hair), before)
    assert ids.LIVE_REST in live_kept.trouble(hair)


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Python cannot do that before Blender 4.3")
def test_bezier_handles_follow():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    hair.data.set_types(type="BEZIER")
    rng = np.random.default_rng(1)
    points = scenes.strands(hair)
    for name in ("handle_left", "handle_right"):
        handles = points + rng.normal(0, 0.01, points.shape)
        attributes.write(hair.data, name, "FLOAT_VECTOR", "POINT", handles)
    follow(hair)
    bpy.context.scene.frame_set(30)
    now = follow_truth.on_surface(ob, hair.data, live_scenes.relation(ob, hair))
    for name in ("position", "handle_left", "handle_right"):
        at_rest = attributes.read(hair.data, live_attributes.rest_name(name)).reshape(points.shape)
        expected = follow_truth.moved(at_rest, hair.data, now)
        got = attributes.read(hair.data, name).reshape(points.shape)
        assert np.abs(got - expected).max() < 2e-6 * follow_truth.diagonal(ob)
