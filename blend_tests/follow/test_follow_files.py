# SPDX-License-Identifier: GPL-3.0-or-later
"""What follows a surface survives files, undo, copies and links."""

import bpy
import follow_truth
import limitsurf
import numpy as np
import scenes
from follow_scenes import deforming
from limit_surface import ids
from override_scenes import append_collection, check_frames, followed, save, save_collection


def found() -> tuple[bpy.types.Object, bpy.types.Object]:
    return bpy.data.objects["Holes"], bpy.data.objects[ids.HAIR_OBJECT]


def test_a_file_keeps_every_digit(tmp_path):
    _ob, hair = followed()
    bpy.context.scene.frame_set(22)
    shown = follow_truth.shown_strands(hair)
    bpy.ops.wm.open_mainfile(filepath=save(tmp_path))
    np.testing.assert_array_equal(follow_truth.shown_strands(found()[1]), shown)
    check_frames(*found())


def test_undo_takes_following_back_and_redo_brings_it_again():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NONE")
    before = scenes.file_contents()
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.object.limit_follow()
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    ob, hair = found()
    # groups and meshes that lost their users stay until the file is saved
    assert scenes.file_contents()["objects"] == before["objects"]
    assert [m.name for m in ob.modifiers] == ["Wave", "Subdivision"]
    assert not hair.modifiers
    assert ids.TILE not in hair.data.attributes
    bpy.context.scene.frame_set(30)
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), scenes.strands(hair))
    bpy.ops.ed.redo()
    check_frames(*found())


def test_a_duplicate_of_the_hair_follows():
    ob, hair = followed()
    bpy.ops.object.select_all(action="DESELECT")
    hair.select_set(True)
    scenes.activate(hair)
    bpy.ops.object.duplicate()
    twin = bpy.context.active_object
    assert twin.data != hair.data
    check_frames(ob, twin)
    bpy.ops.object.limit_unbind(shape="REST")
    check_frames(ob, hair)


def test_a_linked_duplicate_of_the_hair_follows():
    ob, hair = followed()
    twin = hair.copy()
    twin.location.x += 1
    bpy.context.collection.objects.link(twin)
    check_frames(ob, twin)
    check_frames(ob, hair)


def test_a_linked_collection_follows(tmp_path):
    path = save_collection(tmp_path)
    bpy.context.scene.collection.children.link(append_collection(path, link=True))
    ob, hair = found()
    assert ob.library
    for frame in (1, 19, 30):
        bpy.context.scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        table = bpy.data.objects[f"{ids.TILES_TABLE} of Holes"]
        assert table.library
        # the modifiers of linked objects cannot be disabled, so that limitsurf is asked on the cage
        # that Limit Capture hands on
        mesh = ob.evaluated_get(depsgraph).data
        cage = np.empty(len(mesh.vertices) * 3, np.float32)
        mesh.attributes[ids.CAGE_POSITION].data.foreach_get("vector", cage)
        count = len(ob.data.vertices)
        faces = [list(polygon.vertices) for polygon in ob.data.polygons]
        surface = limitsurf.LimitSurface(
            limitsurf.ControlMesh.from_faces(cage.reshape(-1, 3)[:count].astype(np.float64), faces)
        )
        now = follow_truth.on_surface(ob, hair.data, surface=surface)
        expected = follow_truth.moved(scenes.strands(hair), hair.data, now)
        bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
        assert np.abs(follow_truth.shown_strands(hair) - expected).max() < bound
