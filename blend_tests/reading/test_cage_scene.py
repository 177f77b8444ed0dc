# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers and drivers find the same settings in the private scene as in the user's scene."""

import sys
from pathlib import Path

import bpy
import limit_surface
import node_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes, cage, private_scene
from scenes import add_subsurf

EXTENSION = Path(limit_surface.__file__).parent


def read(ob):
    return cage.read(ob, bpy.context.evaluated_depsgraph_get())


def check_shift(ob, amount):
    """The cage is where Blender shows the mesh, which is shifted along z by so much."""
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    expected = attributes.read(shown, ids.POSITION)
    found = np.array(read(ob).mesh.positions)
    np.testing.assert_array_equal(found, expected)
    shift = found - attributes.read(ob.data, ids.POSITION)
    np.testing.assert_allclose(shift, np.broadcast_to([0, 0, amount], shift.shape), atol=1e-6)


def test_seconds_of_scene_time():
    ob, _ = node_scenes.moved_by_nodes("GeometryNodeInputSceneTime", "Seconds")
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = 60, 1.5
    scene.frame_set(30)
    check_shift(ob, 30 / 40)


def test_active_camera():
    ob, group = node_scenes.moved_by_nodes("GeometryNodeObjectInfo", "Location")
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (1, 2, 3)
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    info = next(n for n in group.nodes if n.bl_idname == "GeometryNodeObjectInfo")
    active = group.nodes.new("GeometryNodeInputActiveCamera")
    group.links.new(active.outputs[0], info.inputs["Object"])
    check_shift(ob, 3)


def displaced_by_driver(path, **target):
    ob = scenes.grid_with_holes()
    displace = ob.modifiers.new("Displace", "DISPLACE")
    displace.direction, displace.mid_level = "Z", 0
    driver = displace.driver_add("strength").driver
    variable = driver.variables.new()
    variable.type, variable.name = "CONTEXT_PROP", "amount"
    variable.targets[0].data_path = path
    for name, value in target.items():
        setattr(variable.targets[0], name, value)
    driver.expression = "amount"
    return ob


def test_custom_properties_of_the_scene():
    bpy.context.scene["amount"] = 0.75
    check_shift(displaced_by_driver('["amount"]'), 0.75)


def test_animated_properties_of_the_scene():
    scene = bpy.context.scene
    for frame in (2, 3, 4):
        scene["amount"] = frame / 10
        scene.keyframe_insert('["amount"]', frame=frame)
    ob = displaced_by_driver('["amount"]')
    scene.frame_set(3)
    check_shift(ob, 0.3)


def test_settings_of_the_scene():
    bpy.context.scene.frame_end = 4
    check_shift(displaced_by_driver("frame_end"), 4)


def test_properties_of_the_view_layer():
    """The properties are those of the current view layer, not of the first one."""
    second = bpy.context.scene.view_layers.new("Second")
    bpy.context.view_layer["amount"], second["amount"] = 0.25, 0.5
    ob = displaced_by_driver('["amount"]', context_property="ACTIVE_VIEW_LAYER")
    second.update()
    found = cage.read(ob, second.depsgraph)
    shift = np.array(found.mesh.positions) - attributes.read(ob.data, ids.POSITION)
    np.testing.assert_allclose(shift[:, 2], 0.5, atol=1e-6)


@pytest.mark.parametrize("can_copy", [True, False])
def test_simplify(can_copy, monkeypatch):
    """Other objects are subdivided as in the user's scene."""
    monkeypatch.setattr(private_scene, "_CAN_COPY", can_copy and private_scene._CAN_COPY)
    bpy.ops.mesh.primitive_cube_add(size=20)
    target = bpy.context.active_object
    add_subsurf(target).levels = 4
    render = bpy.context.scene.render
    render.use_simplify, render.simplify_subdivision = True, 0
    ob = scenes.flat_grid(1)
    shrinkwrap = ob.modifiers.new("Shrinkwrap", "SHRINKWRAP")
    shrinkwrap.target, shrinkwrap.wrap_method = target, "PROJECT"
    shrinkwrap.use_project_z = True
    check_shift(ob, 10)


def rich_scene():
    """Makes a scene with everything that a copy would share with it, or that would be evaluated
    with it.
    """
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = scene.timeline_markers.new("Cut", frame=3).camera = camera
    scene.world = bpy.data.worlds.new("World")
    scene["amount"], scene["whose"] = 1.0, camera
    scene.keyframe_insert('["amount"]', frame=1)
    scene.keying_sets.new(idname="Keys", name="Keys")
    scene.view_layers.new("Second")
    scene.sequence_editor_create()
    scene.background_set = bpy.data.scenes.new("Background")
    scene.collection.children.link(bpy.data.collections.new("Props"))
    ob = scenes.cross()
    add_subsurf(ob)
    assert bpy.ops.rigidbody.world_add() == bpy.ops.rigidbody.object_add() == {"FINISHED"}
    return ob


def users():
    items = (item for kind in scenes.kinds() for item in getattr(bpy.data, kind))
    ids_ = (item for item in items if isinstance(item, bpy.types.ID))
    return {repr(i): (i.users, i.use_fake_user) for i in ids_}


def test_nothing_is_left_and_nobody_counted():
    ob = rich_scene()
    read(ob)
    scene = bpy.context.scene
    before = users(), list(scene.objects), scene.rigidbody_world.collection, scene.background_set
    for _ in range(3):
        read(ob)
    after = users(), list(scene.objects), scene.rigidbody_world.collection, scene.background_set
    assert after == before
    assert scene.sequence_editor is not None


def test_nothing_else_is_evaluated():
    ob = rich_scene()
    for name in ("Prop", "Other prop"):
        prop = bpy.data.objects.new(name, ob.data)
        bpy.data.collections["Props"].objects.link(prop)
        bpy.context.scene.rigidbody_world.collection.objects.link(prop)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    with cage.evaluated_copy(ob, 0, depsgraph) as copy:
        layer = bpy.data.scenes[ids.CAGE_SCENE].view_layers[0]
        evaluated = {i.name for i in layer.depsgraph.ids if isinstance(i, bpy.types.Object)}
        assert evaluated == {copy.name, "Camera"}


@pytest.mark.parametrize("where", ["scene", "collection"])
def test_large_files_are_not_slow(where):
    """The time with so many objects is measured by tools/bench_blender.py."""
    ob = scenes.cross()
    collection = bpy.context.scene.collection
    if where == "collection":
        collection = bpy.data.collections.new("All")
        bpy.context.scene.collection.children.link(collection)
    counts = []
    for others in (30, 2970):
        for _ in range(others):
            collection.objects.link(bpy.data.objects.new("Thing", None))
        bpy.context.view_layer.update()
        counts.append(steps_of(lambda: read(ob)))
    few, many = counts
    assert few > 100
    # A scene's own objects are unlinked from its copy one by one, those of collections are not.
    assert many - few <= (2 * 2970 if where == "scene" else 0)


def steps_of(work):
    """Returns how many lines of the extension run. Others do not count: the garbage collector may
    call the tests' own finalizers meanwhile.
    """
    count = 0

    def see(frame, event, _argument):
        nonlocal count
        if not Path(frame.f_code.co_filename).is_relative_to(EXTENSION):
            return None
        count += event == "line"
        return see

    sys.settrace(see)
    try:
        work()
    finally:
        sys.settrace(None)
    return count
