# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading a cage changes nothing in the file, and an object without a cage is refused with a
reason.
"""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.errors import CageError
from limit_surface.reading import cage
from scenes import add_mesh, add_subsurf


def read(ob):
    return cage.read(ob, bpy.context.evaluated_depsgraph_get())


def refusal(ob, pattern):
    """Checks the operator's error message, and that the file does not change."""
    scenes.activate(ob)
    before = scenes.file_contents()
    selected = bpy.context.selected_objects
    with pytest.raises(RuntimeError, match=pattern):
        bpy.ops.object.limit_hair_add()
    assert scenes.file_contents() == before
    assert bpy.context.active_object == ob
    assert bpy.context.selected_objects == selected


def test_loose_edges_away_from_all_faces():
    ob = add_mesh(
        "Loose",
        [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 2, 0), (3, 2, 0)],
        [(0, 1, 2, 3)],
        edges=[(4, 5)],
    )
    assert read(ob).ptex_face_count == 1


def test_multiresolution():
    ob = scenes.cross()
    modifier = ob.modifiers.new("Multires", "MULTIRES")
    refusal(ob, "Multiresolution .Multires. is not supported: apply it or disable it")
    modifier.show_viewport = False
    assert read(ob).ptex_face_count == 5


def test_simulations():
    ob = scenes.cross()
    cloth = ob.modifiers.new("Silk", "CLOTH")
    refusal(ob, "simulation Silk stands before")
    cloth.show_viewport = False
    assert read(ob).ptex_face_count == 5


def test_simulations_in_nested_node_groups():
    inner, outer = (bpy.data.node_groups.new(n, "GeometryNodeTree") for n in ("Inner", "Outer"))
    for group in (inner, outer):
        for in_out in ("INPUT", "OUTPUT"):
            group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
        nodes = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
        group.links.new(nodes[0].outputs[0], nodes[1].inputs[0])
    outer.nodes.new("GeometryNodeGroup").node_tree = inner
    ob = scenes.cross()
    ob.modifiers.new("Nodes", "NODES").node_group = outer
    assert read(ob).ptex_face_count == 5
    inner.nodes.new("GeometryNodeSimulationOutput")
    refusal(ob, "simulation Nodes stands before")


def test_no_faces():
    refusal(add_mesh("Wire", [(0, 0, 0), (1, 0, 0)], [], [(0, 1)]), "Wire has no faces")


def test_positions_that_are_not_finite():
    ob = scenes.cross()
    ob.data.vertices[3].co.x = np.nan
    refusal(ob, "vertex 3 .*finite")


@pytest.mark.parametrize("kind", ["edge", "vertex"])
def test_creases_that_are_no_numbers(kind):
    ob = scenes.cross()
    getattr(ob.data, f"{kind}_creases_ensure")().data[2].value = np.nan
    attribute = {"edge": "crease_edge", "vertex": "crease_vert"}[kind]
    refusal(ob, f"Cross: the crease of {kind} 2 is not a number .attribute {attribute}; 1 in all")


def test_hidden_by_animation():
    """Blender does not evaluate such an object, so its mesh would be out of date."""
    ob = scenes.cross()
    for frame, hidden in ((1, False), (5, True)):
        ob.hide_viewport = hidden
        ob.keyframe_insert("hide_viewport", frame=frame)
    ob.hide_viewport = False
    # the animation is not evaluated yet, so the mesh is still valid
    bpy.context.scene.frame_current = 7
    with pytest.raises(CageError, match="hidden in the viewport at this frame"):
        cage.read(ob, bpy.context.evaluated_depsgraph_get())
    assert len(bpy.data.scenes) == 1


def test_rules_are_read_from_the_object():
    ob = scenes.cross()
    assert (read(ob).rules.subsurf, read(ob).rules.boundary, read(ob).ignored) == ("", "smooth", ())
    add_subsurf(ob, "PRESERVE_CORNERS")
    ob.modifiers.new("Smooth", "SMOOTH")
    found = read(ob)
    assert (found.rules.subsurf, found.rules.boundary) == ("Subdivision", "corners")
    assert found.ignored == ("Smooth",)


def test_object_is_left_alone():
    ob = scenes.grid_with_holes()
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Up")
    driver = key.driver_add("value").driver
    driver.expression = "frame / 10"
    ob.modifiers.new("Displace", "DISPLACE")
    add_subsurf(ob)
    bpy.context.scene.frame_set(4, subframe=0.25)
    before = scenes.file_contents(), [m.name for m in ob.modifiers], ob.data.users
    read(ob)
    assert (scenes.file_contents(), [m.name for m in ob.modifiers], ob.data.users) == before
    assert bpy.context.scene.frame_float == 4.25
    assert key.value == pytest.approx(0.4, abs=0.03)


def test_handlers_of_the_private_scene_can_be_told():
    """No frame-change handler is called, and is_busy() is true in the handlers that are called."""
    ob = scenes.cross()
    called = []

    def note(name):
        return lambda scene, *_: called.append((name, scene.name, cage.is_busy()))

    names = ("frame_change_pre", "frame_change_post", "depsgraph_update_post")
    handlers = [(getattr(bpy.app.handlers, name), note(name)) for name in names]
    for handler, function in handlers:
        handler.append(function)
    try:
        read(ob)
    finally:
        for handler, function in handlers:
            handler.remove(function)
    assert not [name for name, _, _ in called if name.startswith("frame_change")]
    assert all(busy for _, scene, busy in called if scene != "Scene")
    assert not cage.is_busy()


def test_linked_and_overridden_objects(tmp_path):
    """A character comes from a library, as it is and as an override."""
    ob = scenes.cross()
    ob.modifiers.new("Displace", "DISPLACE").strength = 0.2
    add_subsurf(ob, "PRESERVE_CORNERS")
    expected = np.array(read(ob).mesh.positions)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "library.blend"))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.objects = ["Cross"]
    linked = wanted.objects[0]
    bpy.context.collection.objects.link(linked)
    override = linked.override_create()
    bpy.context.collection.objects.link(override)
    for ob in (linked, override):
        found = read(ob)
        np.testing.assert_array_equal(np.array(found.mesh.positions), expected)
        assert found.rules.boundary == "corners"
        hair = scenes.add_hair(ob)
        assert hair.data.surface == hair.parent == ob
