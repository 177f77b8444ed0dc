# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair that follows a surface live which itself follows another surface live."""

import bmesh
import bpy
import follow_truth
import live_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import live_kept
from limit_surface.reading import attributes
from live_scenes import check_hair, deforming, follow, limit_of


def chain(order: str) -> tuple[bpy.types.Object, bpy.types.Object, bpy.types.Object]:
    """Adds a surface that deforms, a mesh on it, and hair on that mesh. The names say in which
    order Blender lists them.
    """
    body = deforming("cross")
    assert bpy.ops.object.limit_mesh(levels=1, follow="NONE", store_locations=True) == {"FINISHED"}
    cloth = bpy.context.object
    hair = scenes.add_hair(cloth, follow="NONE")
    for ob, name in zip((body, cloth, hair), order, strict=True):
        ob.name = name
    follow(cloth, hair)
    return body, cloth, hair


@pytest.mark.parametrize("order", ["ABC", "CBA", "BAC"])
def test_each_frame_is_that_of_the_surface_on_which_it_stands(order):
    _, cloth, hair = chain(order)
    for frame in (1, 30, 7, 12):
        bpy.context.scene.frame_set(frame)
        check_hair(cloth, hair)


def test_a_frame_depends_on_nothing_but_itself():
    _, _, hair = chain("CBA")

    def shown(frame):
        bpy.context.scene.frame_set(frame)
        return follow_truth.shown_strands(hair).tobytes()

    forwards = {frame: shown(frame) for frame in range(1, 9)}
    for frame in (8, 3, 7, 1):
        live_kept.forget()  # as after undo, and in another file
        assert shown(frame) == forwards[frame]
    assert len(set(forwards.values())) == 8


def test_one_change_moves_the_whole_chain():
    body, cloth, hair = chain("CBA")
    before = follow_truth.shown_strands(hair).copy()
    body.modifiers["Wave"].height *= 2
    bpy.context.view_layer.update()
    assert np.abs(follow_truth.shown_strands(hair) - before).max() > 0.02
    check_hair(cloth, hair)


def test_a_surface_that_another_one_that_follows_deforms():
    """The hair stands on a mesh of its own, which is bound to the one that follows."""
    _, cloth, old_hair = chain("CBA")
    bpy.data.objects.remove(old_hair)
    copy = cloth.copy()
    copy.data = cloth.data.copy()
    copy.modifiers.clear()
    copy.name = "A surface that Blender lists first"
    bpy.context.collection.objects.link(copy)
    copy.modifiers.new("Bound", "SURFACE_DEFORM").target = cloth
    scenes.activate(copy)
    assert bpy.ops.object.surfacedeform_bind(modifier="Bound") == {"FINISHED"}
    hair = scenes.add_hair(copy, follow="NONE")
    follow(hair)
    for frame in (1, 30, 7):
        bpy.context.scene.frame_set(frame)
        roots = follow_truth.shown_strands(hair)[:, 0].copy()  # limit_of may update the scene
        expected = limit_of(hair).evaluate(*scenes.locations(hair.data)).position
        assert np.abs(roots - expected).max() < 1e-5


def test_things_on_each_other_do_not_hang():
    body, cloth, _ = chain("CBA")
    body.modifiers.new("Bound", "SHRINKWRAP").target = cloth
    bpy.context.scene.frame_set(30)
    bpy.context.scene.frame_set(1)


@pytest.mark.parametrize("order", ["ABC", "CBA", "BAC"])
def test_edits_are_taken_up_before_the_surface_moves(order, tmp_path):
    """In a file that was just opened, nothing is known about the frame in which it was saved."""
    chain(order)
    path = str(tmp_path / "chain.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    hair = bpy.data.objects[order[2]]
    before = live_scenes.rest(hair).copy()
    positions = attributes.read(hair.data, ids.POSITION) + [0, 0, 0.02]
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)
    hair.data.update_tag()
    bpy.context.scene.frame_set(30)
    moved = np.linalg.norm(live_scenes.rest(hair) - before, axis=2)
    np.testing.assert_allclose(moved, 0.02, atol=1e-6)


def button_in_edit_mode(cloth: bpy.types.Object, rows: slice) -> bpy.types.Object:
    """Adds a mesh that follows the garment live, and lifts some of its vertices by 0.05 in Edit
    Mode, in which it stays.
    """
    scenes.activate(cloth)
    bpy.ops.object.select_all(action="DESELECT")
    cloth.select_set(True)
    assert bpy.ops.object.limit_mesh(levels=1, follow="NONE", store_locations=True) == {"FINISHED"}
    button = bpy.context.object
    follow(button)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ed.undo_push(message="In Edit Mode")
    edited = bmesh.from_edit_mesh(button.data)
    edited.verts.ensure_lookup_table()
    for vertex in edited.verts[rows]:
        vertex.co.z += 0.05
    bmesh.update_edit_mesh(button.data)
    bpy.ops.ed.undo_push(message="Edited")
    return button


def move_the_surface(by: str) -> None:
    if by == "frame":
        bpy.context.scene.frame_set(30)
    else:
        bpy.data.objects["C"].modifiers["Wave"].height = 0.6
        bpy.context.view_layer.update()


def lifted(button: bpy.types.Object) -> np.ndarray:
    """Leaves Edit Mode. Returns how far the vertices at rest are from the surface."""
    if bpy.context.object.mode == "EDIT":
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    offset = attributes.read(button.data, ids.LIVE_REST)
    offset -= attributes.read(button.data, ids.REST_ROOT)
    return np.linalg.norm(offset, axis=1)


def check_lifted(button: bpy.types.Object, rows: slice) -> None:
    expected = np.zeros(len(button.data.vertices))
    expected[rows] = 0.05
    np.testing.assert_allclose(lifted(button), expected, atol=1e-5)


ONE, ALL = slice(3, 4), slice(None)


@pytest.mark.parametrize("rows", [ONE, ALL], ids=["one", "all"])
@pytest.mark.parametrize("by", ["frame", "modifier"])
def test_an_edit_that_lasts_while_the_surface_moves(by, rows):
    """Other hair has the garment move while a mesh on it is in Edit Mode."""
    _, cloth, _ = chain("CBA")
    button = button_in_edit_mode(cloth, rows)
    move_the_surface(by)
    check_lifted(button, rows)


@pytest.mark.parametrize("rows", [ONE, ALL], ids=["one", "all"])
@pytest.mark.parametrize("by", ["frame", "modifier"])
def test_undo_in_edit_mode_while_the_surface_moves(by, rows):
    _, cloth, _ = chain("CBA")
    button = button_in_edit_mode(cloth, rows)
    edited = bmesh.from_edit_mesh(button.data)
    for vertex in edited.verts:
        vertex.co.x += 3
    bmesh.update_edit_mesh(button.data)
    bpy.ops.ed.undo_push(message="Edited again")
    move_the_surface(by)
    bpy.ops.ed.undo()
    button = bpy.context.object
    assert button.mode == "EDIT"
    check_lifted(button, rows)


@pytest.mark.parametrize("rows", [ONE, ALL], ids=["one", "all"])
def test_a_file_that_was_saved_in_edit_mode_after_the_surface_had_moved(rows, tmp_path):
    """The pose in which the edit was made is not in the file, but its frame is."""
    body, cloth, _ = chain("CBA")
    button = button_in_edit_mode(cloth, rows)
    names = body.name, button.name
    move_the_surface("frame")
    path = str(tmp_path / "chain.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    button = bpy.data.objects[names[1]]
    assert lifted(button).max() < 1e-6  # the edit waits
    trouble = live_kept.trouble(button)
    assert f"{button.name} was edited in frame 1, and B has moved since" in trouble
    bpy.context.scene.frame_set(1)
    assert live_kept.trouble(button) == ""
    check_lifted(button, rows)
    bpy.context.scene.frame_set(30)
    check_lifted(button, rows)


def test_a_node_group_whose_inputs_have_the_same_name():
    """The surface reads the garment by the second of them."""
    _, cloth, old_hair = chain("CBA")
    bpy.data.objects.remove(old_hair)
    group = bpy.data.node_groups.new("Copy", "GeometryNodeTree")
    group.is_modifier = True
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    for _ in range(2):
        group.interface.new_socket("Object", in_out="INPUT", socket_type="NodeSocketObject")
    begin, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    info = group.nodes.new("GeometryNodeObjectInfo")
    group.links.new(begin.outputs[2], info.inputs["Object"])
    group.links.new(info.outputs["Geometry"], end.inputs[0])
    copy = scenes.cross()
    copy.name = "A surface that Blender lists first"
    modifier = copy.modifiers.new("Copy", "NODES")
    modifier.node_group = group
    inputs = getattr(getattr(modifier, "properties", None), "inputs", None)
    if inputs is None:  # before Blender 5.2
        modifier["Socket_3"] = cloth
    else:
        inputs.Socket_3.value = cloth
    copy.update_tag()
    bpy.context.view_layer.update()
    hair = scenes.add_hair(copy, follow="NONE")
    follow(hair)
    for frame in (30, 7):
        bpy.context.scene.frame_set(frame)
        roots = follow_truth.shown_strands(hair)[:, 0].copy()
        expected = limit_of(hair).evaluate(*scenes.locations(hair.data)).position
        assert np.abs(roots - expected).max() < 1e-5


def test_a_surface_that_a_driver_bends_by_an_empty_on_the_garment():
    _, cloth, old_hair = chain("CBA")
    bpy.data.objects.remove(old_hair)
    empty = bpy.data.objects.new("On the garment", None)
    bpy.context.collection.objects.link(empty)
    empty.parent, empty.parent_type, empty.parent_vertices = cloth, "VERTEX", [2, 2, 2]
    other = scenes.cross()
    other.name = "A surface that Blender lists first"
    other.shape_key_add(name="Basis")
    key = other.shape_key_add(name="Raised")
    key.slider_min, key.slider_max = -10, 10
    key.data.foreach_set("co", (attributes.read(other.data, ids.POSITION) + [0, 0, 1]).ravel())
    driver = key.driver_add("value").driver
    variable = driver.variables.new()
    variable.type, driver.expression = "TRANSFORMS", "var"
    variable.targets[0].id, variable.targets[0].transform_type = empty, "LOC_Z"
    bpy.context.view_layer.update()
    hair = scenes.add_hair(other, follow="NONE")
    follow(hair)
    heights = set()
    for frame in (30, 7, 12):
        bpy.context.scene.frame_set(frame)
        roots = follow_truth.shown_strands(hair)[:, 0].copy()
        expected = limit_of(hair).evaluate(*scenes.locations(hair.data)).position
        assert np.abs(roots - expected).max() < 1e-5
        heights.add(round(float(roots[0, 2]), 2))
    assert len(heights) == 3
