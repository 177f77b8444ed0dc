# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets that Geometry Nodes move."""

import bpy
import scenes


def moved_by_nodes(node_type, output):
    """Adds a sheet that Geometry Nodes move along z by the node's value."""
    ob = scenes.grid_with_holes()
    group = bpy.data.node_groups.new("Move", "GeometryNodeTree")
    group.is_modifier = True
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    nodes, link = group.nodes, group.links.new
    move = nodes.new("GeometryNodeSetPosition")
    along_z = nodes.new("ShaderNodeVectorMath")
    along_z.operation = "MULTIPLY"
    along_z.inputs[1].default_value = (0, 0, 1)
    link(nodes.new(node_type).outputs[output], along_z.inputs[0])
    link(along_z.outputs[0], move.inputs["Offset"])
    link(nodes.new("NodeGroupInput").outputs[0], move.inputs["Geometry"])
    link(move.outputs[0], nodes.new("NodeGroupOutput").inputs[0])
    ob.modifiers.new("Nodes", "NODES").node_group = group
    return ob, group
