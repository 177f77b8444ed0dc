# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones' heads on the target's limit surface, and the resulting tails, joints and rolls."""

import bpy
import numpy as np
import pytest
import scenes
from mathutils import Matrix
from snap_scenes import BONES
from snap_truth import Truth, add_object, stretched

EXACT = 1e-6


@pytest.fixture
def target():
    ob = stretched(scenes.cross())
    bpy.context.scene.limit_surface.target = ob
    ob.select_set(False)
    return ob


@pytest.fixture
def armature(target):
    ob = add_object(target.location, bpy.data.armatures.new("Armature"))
    ob.rotation_euler, ob.scale = (0.2, 0.3, 0.1), (1.5, 1.5, 1.5)
    scenes.activate(ob)
    bpy.context.view_layer.update()
    bpy.ops.object.mode_set(mode="EDIT")
    for name, (head, tail, parent, connected) in BONES.items():
        bone = ob.data.edit_bones.new(name)
        bone.head, bone.tail, bone.roll = head, tail, 0.4
        if parent:
            bone.parent, bone.use_connect = ob.data.edit_bones[parent], connected
    select(ob, {})
    yield ob
    bpy.ops.object.mode_set(mode="OBJECT")


def select(ob, chosen):
    """Selects whole bones, or with "joint" the one joint that three bones share."""
    bones = ob.data.edit_bones
    for bone in bones:
        bone.select = bone.select_head = bone.select_tail = bone.name in chosen
    for bone in bones:
        if bone.use_connect and bone.parent.select_tail:
            bone.select_head = True
    if "joint" in chosen:
        bones["root"].select_tail = True
        bones["middle"].select_head = bones["other"].select_head = True


def ends(ob):
    """Returns the heads and tails of all bones, in world space."""
    bones = ob.data.edit_bones
    return (
        {b.name: np.array(ob.matrix_world @ b.head) for b in bones},
        {b.name: np.array(ob.matrix_world @ b.tail) for b in bones},
    )


def snapped(ob, chosen, **properties):
    select(ob, chosen)
    before = ends(ob)
    assert bpy.ops.object.limit_snap(**properties) == {"FINISHED"}
    assert bpy.context.mode == "EDIT_ARMATURE"
    heads, tails = ends(ob)
    for bone in ob.data.edit_bones:
        if bone.use_connect:
            np.testing.assert_array_equal(heads[bone.name], tails[bone.parent.name])
    return *before, heads, tails


def check_on_surface(truth, points):
    np.testing.assert_allclose(truth.distances(np.array(points)), 0, atol=EXACT)


def test_a_bone_moves_as_a_whole(armature, target):
    truth = Truth(target)
    heads, tails, new_heads, new_tails = snapped(armature, {"loose"})
    check_on_surface(truth, [new_heads["loose"]])
    offset = tails["loose"] - heads["loose"]
    np.testing.assert_allclose(new_tails["loose"] - new_heads["loose"], offset, atol=EXACT)
    for name in set(BONES) - {"loose"}:
        np.testing.assert_array_equal(new_heads[name], heads[name])
        np.testing.assert_array_equal(new_tails[name], tails[name])


def test_a_chain_is_snapped_joint_by_joint(armature, target):
    truth = Truth(target)
    heads, tails, new_heads, new_tails = snapped(armature, {"root", "middle", "tip"})
    check_on_surface(truth, [new_heads[name] for name in ("root", "middle", "other", "tip")])
    np.testing.assert_allclose(
        new_tails["tip"] - new_heads["tip"], tails["tip"] - heads["tip"], atol=EXACT
    )
    np.testing.assert_array_equal(new_tails["other"], tails["other"])


def test_a_connected_child_comes_along(armature, target):
    heads, tails, new_heads, new_tails = snapped(armature, {"root"})
    moved = new_heads["root"] - heads["root"]
    assert np.linalg.norm(moved) > 0.01
    np.testing.assert_allclose(new_heads["middle"] - heads["middle"], moved, atol=EXACT)
    np.testing.assert_array_equal(new_tails["middle"], tails["middle"])


def test_a_joint_by_itself(armature, target):
    truth = Truth(target)
    heads, tails, new_heads, new_tails = snapped(armature, {"joint"})
    check_on_surface(truth, [new_heads["middle"], new_heads["other"], new_tails["root"]])
    np.testing.assert_array_equal(new_heads["root"], heads["root"])
    np.testing.assert_array_equal(new_tails["middle"], tails["middle"])


@pytest.mark.parametrize("align", ["NORMAL", "NORMAL_DU"])
def test_align(armature, target, align):
    truth = Truth(target)
    heads, tails, new_heads, new_tails = snapped(armature, {"loose"}, align=align)
    along, was = new_tails["loose"] - new_heads["loose"], tails["loose"] - heads["loose"]
    normal = truth.normals_at([new_heads["loose"]])[0]
    np.testing.assert_allclose(along, np.linalg.norm(was) * normal, atol=1e-5)
    if align == "NORMAL_DU":
        face, uv, _ = truth.closest(new_heads["loose"])
        tangent = truth.matrix[:3, :3] @ truth.surface.frames(face, [uv])[0, :, 0]
        bone = armature.data.edit_bones["loose"]
        x = np.array((armature.matrix_world.to_3x3() @ bone.x_axis).normalized())
        np.testing.assert_allclose(x, tangent / np.linalg.norm(tangent), atol=1e-4)


def test_along_the_bone(armature, target):
    truth = Truth(target)
    heads, tails, new_heads, _ = snapped(armature, {"loose"}, mode="NORMAL")
    check_on_surface(truth, [new_heads["loose"]])
    along = tails["loose"] - heads["loose"]
    np.testing.assert_allclose(np.cross(new_heads["loose"] - heads["loose"], along), 0, atol=EXACT)


def test_locked_and_hidden_bones_stay(armature, capfd):
    bones = armature.data.edit_bones
    bones["loose"].lock = True
    bones["tip"].hide = True
    bones["root"].select = True
    heads, _, new_heads, _ = snapped(armature, {"root", "loose", "tip"})
    np.testing.assert_array_equal(new_heads["loose"], heads["loose"])
    np.testing.assert_array_equal(new_heads["tip"], heads["tip"])
    said = capfd.readouterr().out
    assert "1 of 2 bones snapped" in said
    assert "1 bone could not be snapped: the bone is locked (1)" in said


def test_tails_alone_are_nothing_to_snap(armature):
    select(armature, set())
    armature.data.edit_bones["tip"].select_tail = True
    with pytest.raises(RuntimeError, match="Nothing that can be snapped is selected"):
        bpy.ops.object.limit_snap()


@pytest.fixture
def before_a_corner(armature):
    """Adds an armature whose heads are all closest to one corner."""
    corner = scenes.flat_grid(1)
    corner.select_set(False)
    scenes.activate(armature)
    scenes.add_subsurf(corner, "PRESERVE_CORNERS")
    bpy.context.scene.limit_surface.target = corner
    armature.matrix_world = Matrix.Translation((-3, -3, 0))
    bpy.context.view_layer.update()
    return armature


def names_outside_edit_mode(armature):
    """Blender removes bones without length when Edit Mode is left."""
    bpy.ops.object.mode_set(mode="OBJECT")
    names = set(armature.data.bones.keys())
    bpy.ops.object.mode_set(mode="EDIT")
    return names


def test_joints_that_would_meet_stay_apart(before_a_corner, capfd):
    heads, _, new_heads, _ = snapped(before_a_corner, set(BONES))
    for name in ("root", "loose"):
        np.testing.assert_allclose(new_heads[name], (0, 0, 0), atol=EXACT)
    moved = -heads["root"]
    for name in ("middle", "other"):  # with the tail of the root
        np.testing.assert_allclose(new_heads[name], heads[name] + moved, atol=EXACT)
    said = capfd.readouterr().out
    assert "bones could not be snapped: the bone would have no length (2)" in said
    assert names_outside_edit_mode(before_a_corner) == set(BONES)


def test_head_that_would_meet_its_tail(before_a_corner):
    stub = before_a_corner.data.edit_bones.new("stub")
    stub.head, stub.tail = (1, 1, 0), (3, 3, 0)
    select(before_a_corner, set())
    stub.select_head = True
    with pytest.raises(RuntimeError, match="the bone would have no length"):
        bpy.ops.object.limit_snap()
    assert tuple(stub.head) == (1, 1, 0)
    assert names_outside_edit_mode(before_a_corner) == {*BONES, "stub"}
