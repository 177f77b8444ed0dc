# SPDX-License-Identifier: GPL-3.0-or-later
"""Hidden objects stand beside nothing: neither rigid bodies nor instanced collections gain any."""

from collections import Counter

import bpy
import numpy as np
import pytest
import scenes
from children_scenes import add_children, add_guides
from follow_scenes import FRAMES, check_hair, deforming
from limit_surface import ids
from limit_surface.placing import tables


def make_hair(ob: bpy.types.Object) -> None:
    scenes.add_hair(ob, follow="NODES")
    bpy.ops.object.limit_follow(use_proxy=True)


def make_live_children(ob: bpy.types.Object) -> None:
    add_children(add_guides(ob, follow="NODES"), mode="LIVE")


def make_tables(ob: bpy.types.Object) -> None:
    scenes.activate(ob)
    assert bpy.ops.object.limit_sample_tables() == {"FINISHED"}


def attach_an_empty(ob: bpy.types.Object) -> None:
    empty = bpy.data.objects.new("Button", None)
    bpy.context.scene.collection.objects.link(empty)
    empty.location = (1.5, 1.0, 0.4)
    bpy.context.view_layer.update()
    bpy.ops.object.select_all(action="DESELECT")
    empty.select_set(True)
    scenes.activate(ob)
    assert bpy.ops.object.limit_attach() == {"FINISHED"}


def follow_a_curve(ob: bpy.types.Object) -> None:

    data = bpy.data.curves.new("Curve", "CURVE")
    data.dimensions = "3D"
    data.splines.new("POLY").points.add(3)
    curve = bpy.data.objects.new("Curve", data)
    bpy.context.scene.collection.objects.link(curve)
    curve.select_set(True)
    scenes.activate(ob)
    assert bpy.ops.object.limit_follow(mode="NODES") == {"FINISHED"}


MAKERS = (make_hair, make_live_children, make_tables, attach_an_empty, follow_a_curve)


def within(name: str, ob: bpy.types.Object) -> bpy.types.Collection:
    """Makes a collection that is the only one of the object."""
    collection = bpy.data.collections.new(name)
    bpy.context.scene.collection.children.link(collection)
    for other in ob.users_collection:
        other.objects.unlink(ob)
    collection.objects.link(ob)
    scenes.activate(ob)
    return collection


@pytest.mark.parametrize("make", MAKERS)
def test_they_are_no_rigid_bodies(make):
    ob = deforming("grid with holes")
    bpy.ops.rigidbody.object_add(type="PASSIVE")
    make(ob)
    world = bpy.context.scene.rigidbody_world
    assert list(world.collection.objects) == [ob]


@pytest.mark.parametrize("make", MAKERS)
def test_they_are_no_members_of_collections(make):
    ob = deforming("grid with holes")
    collection = within("Plants", ob)
    make(ob)
    assert list(collection.objects) == [ob]


def test_an_attached_object_does_not_fall():
    ob = deforming("grid with holes")
    bpy.ops.rigidbody.object_add(type="PASSIVE")
    ob.modifiers.remove(ob.modifiers["Wave"])
    ob.data.shape_keys.animation_data_clear()
    attach_an_empty(ob)
    button = bpy.data.objects["Button"]
    for frame in range(1, 20):
        bpy.context.scene.frame_set(frame)
    at = button.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation
    np.testing.assert_allclose(at, (1.5, 1.0, 0.4), atol=1e-5)


def test_a_plant_with_hair_is_still_scattered():
    plant = deforming("cross")
    within("Plants", plant)
    ground = scenes.flat_grid(4)
    scenes.add_points(
        ground, per_side=1, instances="COLLECTION", collection="Plants", follow="NONE"
    )
    scenes.add_hair(plant, follow="NODES")
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    shown = Counter(i.object.name for i in depsgraph.object_instances if i.is_instance)
    assert shown == {plant.name: 16}


def test_those_of_earlier_versions_are_moved_when_something_is_bound_again():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES")
    collection = within("Plants", ob)
    table = tables.of_surface(ob)
    hidden = (table, tables.points_of(table))
    for each in hidden:
        bpy.context.scene.collection.objects.unlink(each)
        collection.objects.link(each)
    scenes.activate(hair)
    bpy.ops.object.limit_follow()
    assert list(collection.objects) == [ob]
    assert all(each.users_collection == (bpy.context.scene.collection,) for each in hidden)


def test_the_scene_that_holds_them_may_be_deleted(tmp_path):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES")
    collection = within("Groom", ob)
    attach_an_empty(ob)
    button = bpy.data.objects["Button"]
    for each in (hair, button):
        collection.objects.link(each)
    bpy.context.scene.frame_set(30)
    before = np.array(button.matrix_world)

    other = bpy.data.scenes.new("Other")
    other.collection.children.link(collection)
    bpy.data.scenes.remove(bpy.context.scene)
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    ob, hair = bpy.data.objects["Holes"], bpy.data.objects[ids.HAIR_OBJECT]
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        check_hair(ob, hair)
    np.testing.assert_allclose(bpy.data.objects["Button"].matrix_world, before, atol=1e-6)
