# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that deform, hair that follows them live, and what it should look like."""

import bpy
import follow_truth
import limitsurf
import numpy as np
import scenes
from follow_scenes import FRAMES, deforming
from follow_truth import relation
from limit_surface import ids
from limit_surface.reading import attributes, cage

__all__ = ["FRAMES", "deforming", "relation"]


def with_armature(scene: str) -> bpy.types.Object:
    """Adds a surface that one of two bones bends and another holds."""
    ob = scenes.SCENES[scene]()
    armature = bpy.data.armatures.new("Rig")
    rig = bpy.data.objects.new("Rig", armature)
    bpy.context.collection.objects.link(rig)
    scenes.activate(rig)
    bpy.ops.object.mode_set(mode="EDIT")
    for name, x in (("Left", 0.0), ("Right", 5.0)):
        bone = armature.edit_bones.new(name)
        bone.head, bone.tail = (x, 0, -1), (x, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    positions = attributes.read(ob.data, ids.POSITION)
    for name, weight in (("Left", 1 - positions[:, 0] / 5), ("Right", positions[:, 0] / 5)):
        group = ob.vertex_groups.new(name=name)
        for vertex, value in enumerate(weight):
            group.add([vertex], float(value), "REPLACE")
    ob.modifiers.new("Armature", "ARMATURE").object = rig
    bone = rig.pose.bones["Left"]
    bone.rotation_mode = "XYZ"
    for frame, angle in ((1, 0.0), (30, 0.9)):
        bone.rotation_euler = (0, angle, 0)
        bone.keyframe_insert("rotation_euler", frame=frame)
    scenes.add_subsurf(ob)
    bpy.context.scene.frame_set(bpy.context.scene.frame_current)
    return ob


def animate_creases(ob: bpy.types.Object) -> None:
    """Adds nodes that make all edges sharper from frame 1 to 30."""
    group = bpy.data.node_groups.new("Creases", "GeometryNodeTree")
    group.is_modifier = True
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    begin, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    store = group.nodes.new("GeometryNodeStoreNamedAttribute")
    store.data_type, store.domain = "FLOAT", "EDGE"
    store.inputs["Name"].default_value = ids.EDGE_CREASE
    time = group.nodes.new("GeometryNodeInputSceneTime")
    share = group.nodes.new("ShaderNodeMath")
    share.operation = "DIVIDE"
    share.inputs[1].default_value = 40
    group.links.new(time.outputs["Frame"], share.inputs[0])
    group.links.new(
        share.outputs[0], next(s for s in store.inputs if s.name == "Value" and s.enabled)
    )
    group.links.new(begin.outputs[0], store.inputs["Geometry"])
    group.links.new(store.outputs[0], end.inputs[0])
    ob.modifiers.new("Creases", "NODES").node_group = group


def follow(*things: bpy.types.Object, mode: str = "LIVE") -> None:
    for thing in things:
        for ob in bpy.context.selected_objects:
            ob.select_set(False)
        thing.select_set(True)
        scenes.activate(thing)
        assert bpy.ops.object.limit_follow(mode=mode) == {"FINISHED"}


def rest(hair: bpy.types.Object) -> np.ndarray:
    """Returns the strands at rest (strands, points, 3)."""
    return attributes.read(hair.data, ids.LIVE_REST).reshape(len(hair.data.curves), -1, 3)


def check_hair(
    ob: bpy.types.Object, hair: bpy.types.Object, surface: limitsurf.LimitSurface | None = None
) -> None:
    shown = follow_truth.shown_strands(hair).copy()  # reading the surface may update the scene
    now = follow_truth.on_surface(ob, hair.data, relation(ob, hair), surface)
    error = np.abs(shown - follow_truth.moved(rest(hair), hair.data, now)).max()
    assert error < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)


def limit_of(hair: bpy.types.Object) -> limitsurf.LimitSurface:
    """Returns the limit surface of the hair's surface in this frame."""
    return cage.read(hair.data.surface, bpy.context.evaluated_depsgraph_get()).surface()
