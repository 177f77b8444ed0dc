# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair follows whatever deforms or moves its surface: 12 frames and subframes, against limitsurf on
the control mesh that Blender evaluates.
"""

from collections.abc import Callable

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from mathutils import Matrix

FRAMES = [(frame, subframe) for frame in (1, 4, 9, 14, 21, 30) for subframe in (0.0, 0.375)]


def animate_value(owner: bpy.types.bpy_struct, path: str, first: object, last: object) -> None:
    for frame, value in ((1, first), (30, last)):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def add(name: str, data: bpy.types.ID | None) -> bpy.types.Object:
    ob = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(ob)
    return ob


def shape_keys(ob: bpy.types.Object) -> None:
    follow_truth.animate(ob)


def wave(ob: bpy.types.Object) -> None:
    ob.modifiers.new("Wave", "WAVE").height = 0.4


def armature(ob: bpy.types.Object) -> None:
    rig = add("Rig", bpy.data.armatures.new("Rig"))
    scenes.activate(rig)
    bpy.ops.object.mode_set(mode="EDIT")
    for i in range(2):
        bone = rig.data.edit_bones.new(f"Bone{i}")
        bone.head, bone.tail = (2.5 * i, 0, 0), (2.5 * i + 2.5, 0, 0)
        bone.use_deform = True
    bpy.ops.object.mode_set(mode="OBJECT")
    x = attributes.read(ob.data, ids.POSITION)[:, 0]
    share = (x - x.min()) / np.ptp(x)
    for i in range(2):
        group = ob.vertex_groups.new(name=f"Bone{i}")
        for vertex, weight in enumerate(share if i else 1 - share):
            group.add([vertex], float(weight), "REPLACE")
    ob.modifiers.new("Armature", "ARMATURE").object = rig
    bone = rig.pose.bones["Bone1"]
    bone.rotation_mode = "XYZ"
    animate_value(bone, "rotation_euler", (0, 0, 0), (0.4, 0.3, 0.9))


def lattice(ob: bpy.types.Object) -> None:
    cage = add("Lattice", bpy.data.lattices.new("Lattice"))
    cage.scale = (8, 8, 4)
    ob.modifiers.new("Lattice", "LATTICE").object = cage
    cage.shape_key_add(name="Basis")
    key = cage.shape_key_add(name="Moved")
    moved = np.random.default_rng(3).uniform(-0.6, 0.6, (len(key.data), 3)).astype(np.float32)
    key.data.foreach_set("co", moved.ravel())
    animate_value(key, "value", 0.0, 1.0)


def driver(ob: bpy.types.Object) -> None:
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Driven")
    positions = attributes.read(ob.data, ids.POSITION)
    key.data.foreach_set("co", (positions * [1, 1.3, -1]).astype(np.float32).ravel())
    key.driver_add("value").driver.expression = "sin(frame / 10)"


def parent(ob: bpy.types.Object) -> None:
    wave(ob)
    carrier = add("Carrier", None)
    ob.parent = carrier
    ob.matrix_parent_inverse = Matrix.Translation((0.5, 0, 1)) @ Matrix.Diagonal((1, 2, 1, 1))
    animate_value(carrier, "rotation_euler", (0, 0, 0), (1.0, -0.5, 2.0))


def constraint(ob: bpy.types.Object) -> None:
    wave(ob)
    target = add("Target", None)
    animate_value(target, "location", (1, 2, 3), (-3, 1, 4))
    ob.constraints.new("TRACK_TO").target = target
    ob.constraints.new("COPY_LOCATION").target = target


def scale(ob: bpy.types.Object) -> None:
    shape_keys(ob)
    animate_value(ob, "scale", (1, 1, 1), (0.4, -1.5, 2.0))


DEFORMERS: dict[str, Callable[[bpy.types.Object], None]] = {
    made.__name__: made
    for made in (shape_keys, wave, armature, lattice, driver, parent, constraint, scale)
}


@pytest.mark.every(3)
@pytest.mark.parametrize("is_child", [True, False])
@pytest.mark.parametrize("name", DEFORMERS)
def test_hair_follows(name, is_child):
    ob = scenes.grid_with_holes()
    DEFORMERS[name](ob)
    scenes.add_subsurf(ob)
    bpy.context.scene.frame_set(1)
    hair = scenes.add_hair(ob, per_side=3, tilt=(0.4, 0.2), length=0.4, follow="NONE")
    at_rest = follow_truth.AtRest.read(ob, hair)
    if not is_child:
        hair.parent = None
        hair.matrix_world = Matrix.Translation((1, -2, 0.5)) @ Matrix.Diagonal((1.5, 0.8, 1, 1))
    scenes.activate(hair)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    reach = []
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        to_hair = follow_truth.relation(ob, hair)
        now = follow_truth.on_surface(ob, hair.data, to_hair)
        expected = at_rest.carried(now)
        shown = follow_truth.shown_strands(hair)
        # in the space of the hair, and with the digits that its coordinates have there
        size = max(follow_truth.diagonal(ob) * np.linalg.norm(to_hair[:3, :3], 2), 2)
        size = max(size, np.abs(expected).max())
        assert np.abs(shown - expected).max() < follow_truth.POSITION_BOUND * size
        assert np.abs(shown[:, 0] - now.position).max() < follow_truth.POSITION_BOUND * size
        reach.append(np.abs(shown - scenes.strands(hair)).max())
    assert max(reach) > 0.1


JUMPS = ((30, 0.0), (1, 0.0), (17, 0.5), (2, 0.25), (30, 0.0))


def test_frames_in_any_order_give_the_same():
    ob = scenes.grid_with_holes()
    shape_keys(ob)
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, follow="NODES")
    seen = {}
    for frame, subframe in JUMPS:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        shown = follow_truth.shown_strands(hair)
        np.testing.assert_array_equal(shown, seen.setdefault((frame, subframe), shown))
    assert len(seen) == 4
