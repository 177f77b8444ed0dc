# SPDX-License-Identifier: GPL-3.0-or-later
"""What follows a surface survives files, undo, copies, links and library overrides."""

from pathlib import Path

import bpy
import follow_truth
import limitsurf
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming
from limit_surface import ids
from limit_surface.nodes import groups
from limit_surface.nodes.follow import TILES
from limit_surface.placing.followers import modifier_of


def followed(**properties: object) -> tuple[bpy.types.Object, bpy.types.Object]:
    ob = deforming("grid with holes")
    return ob, scenes.add_hair(ob, tilt=(0.4, 0.2), follow="NODES", **properties)


def found() -> tuple[bpy.types.Object, bpy.types.Object]:
    return bpy.data.objects["Holes"], bpy.data.objects[ids.HAIR_OBJECT]


def check_frames(ob: bpy.types.Object, hair: bpy.types.Object) -> None:
    for frame, subframe in ((1, 0.0), (13, 0.5), (30, 0.0)):
        bpy.context.scene.frame_set(frame, subframe=subframe)
        check_hair(ob, hair)


def save(folder: Path) -> str:
    path = str(folder / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return path


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


def append_collection(path: str, link: bool) -> bpy.types.Collection:
    with bpy.data.libraries.load(path, link=link) as (there, here):
        here.collections = [name for name in there.collections if name == "Groom"]
    return here.collections[0]


def save_collection(folder: Path, **properties: object) -> str:
    """Saves surface, hair and tables in a collection, with nothing else."""
    groom = bpy.data.collections.new("Groom")
    bpy.context.scene.collection.children.link(groom)
    layer = bpy.context.view_layer.layer_collection.children["Groom"]
    bpy.context.view_layer.active_layer_collection = layer
    ob, _hair = followed(**properties)
    for each in list(bpy.context.scene.objects):
        if each.name not in groom.objects:
            groom.objects.link(each)
    assert ob.name in groom.objects
    path = save(folder)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return path


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


def test_a_library_override_follows_in_its_own_pose(tmp_path):
    path = save_collection(tmp_path)
    linked = append_collection(path, link=True)
    bpy.context.scene.collection.children.link(linked)
    linked.override_hierarchy_create(
        bpy.context.scene, bpy.context.view_layer, do_fully_editable=True
    )
    ob = next(o for o in bpy.data.objects if o.name.startswith("Holes") and not o.library)
    hair = next(o for o in bpy.data.objects if o.type == "CURVES" and not o.library)
    assert ob.override_library
    ob.modifiers["Wave"].height = 0.7
    check_frames(ob, hair)
    bpy.ops.wm.open_mainfile(filepath=save(tmp_path / ".."))
    ob = next(o for o in bpy.data.objects if o.name.startswith("Holes") and not o.library)
    hair = next(o for o in bpy.data.objects if o.type == "CURVES" and not o.library)
    check_frames(ob, hair)


def overridden(tmp_path: Path, **properties: object) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Returns library overrides of a surface and of hair, whose tables are overrides, too."""
    linked = append_collection(save_collection(tmp_path, **properties), link=True)
    bpy.context.scene.collection.children.link(linked)
    linked.override_hierarchy_create(
        bpy.context.scene, bpy.context.view_layer, do_fully_editable=True
    )
    ob = next(o for o in bpy.data.objects if o.name.startswith("Holes") and not o.library)
    hair = next(o for o in bpy.data.objects if o.type == "CURVES" and not o.library)
    return ob, hair


def test_new_hair_on_an_overridden_surface_leaves_overridden_tables_alone(tmp_path):
    ob, hair = overridden(tmp_path)
    table = groups.get_input(modifier_of(hair), TILES)
    assert table.override_library
    assert table.data.library
    rows = len(table.data.vertices)
    layers = bpy.context.view_layer.layer_collection.children
    layer = next(layer for layer in layers if layer.collection.override_library)
    assert ob.name in layer.collection.objects
    bpy.context.view_layer.active_layer_collection = layer
    new = scenes.add_points(ob, follow="NODES")
    own = groups.get_input(modifier_of(new), TILES)
    assert own != table
    assert own.data.library is None
    assert len(table.data.vertices) == rows
    check_frames(ob, hair)


def test_overridden_hair_stays_bound_as_its_own_file_says(tmp_path):
    """Nothing that is written to its points takes effect, so it must keep the tables to which their
    tiles belong. Few strands use other numbers of tiles than the new points do.
    """
    ob, hair = overridden(tmp_path, distribution="UNIFORM", count=12)
    new = scenes.add_points(ob, distribution="UNIFORM", count=20, follow="NODES")
    check_frames(ob, hair)
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    bpy.ops.object.select_all(action="DESELECT")
    empty.select_set(True)
    scenes.activate(ob)
    assert bpy.ops.object.limit_attach() == {"FINISHED"}
    check_frames(ob, hair)
    for operator in (bpy.ops.object.limit_unbind, bpy.ops.object.limit_rebind):
        bpy.ops.object.select_all(action="DESELECT")
        scenes.activate(hair)
        with pytest.raises(RuntimeError, match="Limit Hair is a library override"):
            operator()
    bpy.ops.object.select_all(action="DESELECT")
    for thing in (new, bpy.data.objects["Limit Carrier of Holes"]):
        scenes.activate(thing)
        assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    check_frames(ob, hair)
    bpy.ops.wm.open_mainfile(filepath=save(tmp_path / ".."))
    ob = next(o for o in bpy.data.objects if o.name.startswith("Holes") and not o.library)
    hair = next(o for o in bpy.data.objects if o.type == "CURVES" and not o.library)
    check_frames(ob, hair)
