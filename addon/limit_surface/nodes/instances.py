# SPDX-License-Identifier: GPL-3.0-or-later
"""The groups *Limit Instances* and *Limit Collection Instances*: an instance of an object, or of a
member of a collection, on each point.
"""

import bpy

from .. import ids
from .groups import Kind, add_modifier
from .tree import Socket, Tree, Value

_POINTS = Socket("Geometry", "Geometry", "Points with the attributes rotation and scale")
_MEMBER_POINTS = Socket(
    "Geometry", "Geometry", "Points with the attributes rotation, scale and instance_index"
)
_INSTANCES = Socket("Geometry", "Geometry", "Instances on the points")


def put_instances(points: bpy.types.Object, instance: bpy.types.Object) -> None:
    add_modifier(points, INSTANCES, Instance=instance)


def put_members(points: bpy.types.Object, collection: bpy.types.Collection) -> None:
    add_modifier(points, MEMBERS, Collection=collection)


def placed(tree: Tree, instance: Value) -> bpy.types.Node:
    """Adds the node that puts an instance on each point, as large and as turned as its attributes
    say.
    """
    node = tree.node("GeometryNodeInstanceOnPoints", tree.inputs["Geometry"])
    tree.set(node.inputs["Instance"], instance)
    tree.set(node.inputs["Rotation"], tree.attribute(ids.ROTATION, "QUATERNION"))
    tree.set(node.inputs["Scale"], tree.attribute(ids.SCALE, "FLOAT"))
    return node


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.INSTANCES_GROUP,
        [_POINTS, Socket("Instance", "Object", "Object to put on each point")],
        [_INSTANCES],
        is_modifier=True,
    )
    info = tree.node("GeometryNodeObjectInfo", transform_space="ORIGINAL")
    tree.set(info.inputs["Object"], tree.inputs["Instance"])
    tree.set(info.inputs["As Instance"], True)
    return tree.finish(Geometry=placed(tree, info.outputs["Geometry"]).outputs["Instances"])


def _build_members() -> bpy.types.NodeTree:
    tree = Tree(
        ids.MEMBERS_GROUP,
        [
            _MEMBER_POINTS,
            Socket("Collection", "Collection", "Collection whose members stand on the points"),
        ],
        [_INSTANCES],
        is_modifier=True,
    )
    info = tree.node("GeometryNodeCollectionInfo", transform_space="ORIGINAL")
    tree.set(info.inputs["Collection"], tree.inputs["Collection"])
    tree.set(info.inputs["Separate Children"], True)
    tree.set(info.inputs["Reset Children"], True)
    node = placed(tree, info.outputs[0])
    tree.set(node.inputs["Pick Instance"], True)
    tree.set(node.inputs["Instance Index"], tree.attribute(ids.MEMBER, "INT"))
    return tree.finish(Geometry=node.outputs["Instances"])


INSTANCES = Kind(ids.INSTANCES_GROUP, 3, _build)
MEMBERS = Kind(ids.MEMBERS_GROUP, 1, _build_members)
