# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances on points, by a Geometry Nodes modifier that works without this add-on."""

import bpy

from .. import ids

# the version of the node group; a group of another version in a file is left alone, and a new one
# is made
VERSION = 1


def put_instances(points: bpy.types.Object, instance: bpy.types.Object) -> None:
    group = _find_group() or _make_group()
    modifier = points.modifiers.new(group.name, "NODES")
    modifier.node_group = group
    modifier[_input(group, "Instance").identifier] = instance


def _find_group() -> bpy.types.NodeTree | None:
    return next((g for g in bpy.data.node_groups if g.get(ids.INSTANCES_MARK) == VERSION), None)


def _input(group: bpy.types.NodeTree, name: str) -> bpy.types.NodeTreeInterfaceSocket:
    return next(
        item
        for item in group.interface.items_tree
        if item.item_type == "SOCKET" and item.in_out == "INPUT" and item.name == name
    )


def _make_group() -> bpy.types.NodeTree:
    group = bpy.data.node_groups.new(ids.INSTANCES_GROUP, "GeometryNodeTree")
    group[ids.INSTANCES_MARK] = VERSION
    group.is_modifier = True
    for name, in_out, kind, description in (
        ("Geometry", "OUTPUT", "NodeSocketGeometry", "Instances on the points"),
        ("Geometry", "INPUT", "NodeSocketGeometry", "Points with the attribute rotation"),
        ("Instance", "INPUT", "NodeSocketObject", "Object to put on each point"),
    ):
        group.interface.new_socket(name, in_out=in_out, socket_type=kind, description=description)

    nodes, links = group.nodes, group.links
    inputs = nodes.new("NodeGroupInput")
    rotation = nodes.new("GeometryNodeInputNamedAttribute")
    rotation.data_type = "QUATERNION"
    rotation.inputs["Name"].default_value = ids.ROTATION
    info = nodes.new("GeometryNodeObjectInfo")
    info.transform_space = "ORIGINAL"
    info.inputs["As Instance"].default_value = True
    place = nodes.new("GeometryNodeInstanceOnPoints")
    outputs = nodes.new("NodeGroupOutput")

    links.new(inputs.outputs["Instance"], info.inputs["Object"])
    links.new(inputs.outputs["Geometry"], place.inputs["Points"])
    links.new(info.outputs["Geometry"], place.inputs["Instance"])
    links.new(rotation.outputs["Attribute"], place.inputs["Rotation"])
    links.new(place.outputs["Instances"], outputs.inputs["Geometry"])
    for column, node in enumerate((inputs, info, place, outputs)):
        node.location = (200 * column, 0)
    rotation.location = (200, -240)
    return group
