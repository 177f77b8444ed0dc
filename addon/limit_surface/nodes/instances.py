# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Limit Instances*: an instance of an object on each point."""

import bpy

from .. import ids
from .groups import Kind, add_modifier
from .tree import Socket, Tree


def put_instances(points: bpy.types.Object, instance: bpy.types.Object) -> None:
    add_modifier(points, INSTANCES, Instance=instance)


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.INSTANCES_GROUP,
        [
            Socket("Geometry", "Geometry", "Points with the attribute rotation"),
            Socket("Instance", "Object", "Object to put on each point"),
        ],
        [Socket("Geometry", "Geometry", "Instances on the points")],
        is_modifier=True,
    )
    info = tree.node("GeometryNodeObjectInfo", transform_space="ORIGINAL")
    tree.set(info.inputs["Object"], tree.inputs["Instance"])
    tree.set(info.inputs["As Instance"], True)
    placed = tree.node("GeometryNodeInstanceOnPoints", tree.inputs["Geometry"])
    tree.set(placed.inputs["Instance"], info.outputs["Geometry"])
    tree.set(placed.inputs["Rotation"], tree.attribute(ids.ROTATION, "QUATERNION"))
    return tree.finish(Geometry=placed.outputs["Instances"])


INSTANCES = Kind(ids.INSTANCES_GROUP, 2, _build)
