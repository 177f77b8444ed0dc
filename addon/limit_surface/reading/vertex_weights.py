# SPDX-License-Identifier: GPL-3.0-or-later
"""The weights of vertex groups as whole arrays, read from a mesh and written to one.

Python can access them only vertex by vertex. Geometry Nodes, run in the evaluation of a mesh, copy
them to attributes and back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import bpy
import numpy as np

from .. import ids
from . import attributes, cage

Adjust = Callable[[bpy.types.Object, bpy.types.Scene], None]

_MISSING = -1.0  # weights are from 0 to 1


@contextmanager
def kept(groups: Sequence[str]) -> Iterator[Adjust | None]:
    """Returns a function that changes a copied object before it is evaluated, so that its mesh can
    be `read`; None where there are no groups.
    """
    pairs = [(name, _attribute(i)) for i, name in enumerate(groups)]
    with _copying(pairs, _MISSING) as add_nodes:
        yield add_nodes


def read(mesh: bpy.types.Mesh, count: int) -> list[np.ndarray | None]:
    """Returns the groups that the mesh has kept, with one weight for each vertex; None for groups
    that modifiers remove.
    """
    found = [attributes.read(mesh, _attribute(i)) for i in range(count)]
    return [None if (weights == _MISSING).all() else weights for weights in found]


def with_groups(
    mesh: bpy.types.Mesh,
    groups: Sequence[str],
    weights: np.ndarray,
    depsgraph: bpy.types.Depsgraph,
) -> bpy.types.Mesh:
    """Returns a copy of a mesh with other weights (vertices, groups)."""
    for i, weight in enumerate(weights.T):
        attributes.write(mesh, _attribute(i), "FLOAT", "POINT", weight)
    ob = bpy.data.objects.new(ids.TEMPORARY_MESH, mesh)
    try:
        for group in groups:
            ob.vertex_groups.new(name=group)
        pairs = [(_attribute(i), group) for i, group in enumerate(groups)]
        with (
            _copying(pairs) as add_nodes,
            cage.evaluated_copy(ob, 0, depsgraph, add_nodes) as evaluated,
        ):
            made = bpy.data.meshes.new_from_object(evaluated)
    finally:
        bpy.data.objects.remove(ob)
    for i in range(len(groups)):
        made.attributes.remove(made.attributes[_attribute(i)])
    return made


def _attribute(group: int) -> str:
    return f"{ids.VERTEX_WEIGHT}_{group}"


@contextmanager
def _copying(
    pairs: Sequence[tuple[str, str]], missing: float | None = None
) -> Iterator[Adjust | None]:
    """Makes a node tree that copies attributes or groups to others, by name. A target whose source
    does not exist becomes `missing`, or 0.
    """
    if not pairs:
        yield None
        return
    tree = bpy.data.node_groups.new(ids.WEIGHTS_GROUP, "GeometryNodeTree")
    _fill(tree, pairs, missing)

    def add_nodes(copy: bpy.types.Object, _scene: bpy.types.Scene) -> None:
        copy.modifiers.new(tree.name, "NODES").node_group = tree

    try:
        yield add_nodes
    finally:
        bpy.data.node_groups.remove(tree)


def _fill(
    tree: bpy.types.NodeTree, pairs: Sequence[tuple[str, str]], missing: float | None
) -> None:
    for in_out in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    nodes, links = tree.nodes, tree.links
    geometry = nodes.new("NodeGroupInput").outputs["Geometry"]
    for source, target in pairs:
        weight = nodes.new("GeometryNodeInputNamedAttribute")
        weight.data_type = "FLOAT"
        weight.inputs["Name"].default_value = source
        value = weight.outputs["Attribute"]
        if missing is not None:
            known = nodes.new("GeometryNodeSwitch")
            known.input_type = "FLOAT"
            known.inputs["False"].default_value = missing
            links.new(weight.outputs["Exists"], known.inputs["Switch"])
            links.new(value, known.inputs["True"])
            value = known.outputs["Output"]
        store = nodes.new("GeometryNodeStoreNamedAttribute")
        store.data_type, store.domain = "FLOAT", "POINT"
        store.inputs["Name"].default_value = target
        links.new(value, store.inputs["Value"])
        links.new(geometry, store.inputs["Geometry"])
        geometry = store.outputs["Geometry"]
    links.new(geometry, nodes.new("NodeGroupOutput").inputs["Geometry"])
