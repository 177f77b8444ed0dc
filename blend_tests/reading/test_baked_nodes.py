# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry that a Bake node has stored counts, not what it would compute now."""

import bpy
import node_scenes
import numpy as np
import pytest
from limit_surface import ids
from limit_surface.reading import attributes, cage


def moved_with_time():
    """Adds a sheet that nodes move along z by the number of the frame, and the baking modifier."""
    ob, group = node_scenes.moved_by_nodes("GeometryNodeInputSceneTime", "Frame")
    bake = group.nodes.new("GeometryNodeBake")
    if "Geometry" not in bake.inputs:  # as in Blender 5.2
        bake.bake_items.new("GEOMETRY", "Geometry")
    out = next(node for node in group.nodes if node.bl_idname == "NodeGroupOutput").inputs[0]
    group.links.new(out.links[0].from_socket, bake.inputs["Geometry"])
    group.links.new(bake.outputs["Geometry"], out)
    return ob, ob.modifiers["Nodes"]


@pytest.mark.parametrize("target", ["PACKED", "DISK"])
def test_what_was_baked_is_read(target, tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "bake.blend"))
    ob, modifier = moved_with_time()
    bake = modifier.bakes[0]
    if not hasattr(bake, "bake_target") and target == "PACKED":
        pytest.skip("this Blender bakes only to files")
    if hasattr(bake, "bake_target"):
        bake.bake_target = target
    bake.bake_mode = "STILL"
    bpy.context.scene.frame_set(5)
    baked = bpy.ops.object.geometry_node_bake_single(
        session_uid=ob.session_uid, modifier_name=modifier.name, bake_id=bake.bake_id
    )
    assert baked == {"FINISHED"}
    bpy.context.scene.frame_set(9)
    found = cage.read(ob, bpy.context.evaluated_depsgraph_get()).mesh.positions
    expected = attributes.read(ob.data, ids.POSITION) + np.array([0, 0, 5], np.float32)
    np.testing.assert_allclose(found, expected, atol=1e-6)
