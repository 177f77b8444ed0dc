# SPDX-License-Identifier: GPL-3.0-or-later
"""The weights of all vertex groups as an array, read from a mesh and put on one.

Python sees them vertex by vertex only. Geometry nodes copy them to attributes and back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import bpy
import numpy as np

from .. import ids
from ..reading import attributes, cage

Adjust = Callable[[bpy.types.Object, bpy.types.Scene], None]


@contextmanager
def kept(names: Sequence[str]) -> Iterator[Adjust | None]:
    """Gives what is to be done to a copied object before it is evaluated, so that its mesh can be
    `read`."""
    with _copying([(name, _attribute(i)) for i, name in enumerate(names)]) as add_nodes:
        yield add_nodes


def read(mesh: bpy.types.Mesh, names: Sequence[str]) -> np.ndarray:
    """(vertices, groups); 0 in groups that a mesh does not have."""
    weights = [attributes.read(mesh, _attribute(i)) for i in range(len(names))]
    return np.stack(weights, axis=1) if weights else np.empty((len(mesh.vertices), 0), np.float32)


def with_groups(
    mesh: bpy.types.Mesh,
    names: Sequence[str],
    weights: np.ndarray,
    depsgraph: bpy.types.Depsgraph,
) -> bpy.types.Mesh:
    """Another mesh, alike but for its weights (vertices, groups)."""
    for i, weight in enumerate(weights.T):
        attributes.write(mesh, _attribute(i), "FLOAT", "POINT", weight)
    ob = bpy.data.objects.new(ids.TEMPORARY_MESH, mesh)
    try:
        for group in names:
            ob.vertex_groups.new(name=group)
        pairs = [(_attribute(i), group) for i, group in enumerate(names)]
        with (
            _copying(pairs) as add_nodes,
            cage.evaluated_copy(ob, 0, depsgraph, add_nodes) as evaluated,
        ):
            made = bpy.data.meshes.new_from_object(evaluated)
    finally:
        bpy.data.objects.remove(ob)
    for i in range(len(names)):
        made.attributes.remove(made.attributes[_attribute(i)])
    return made


def _attribute(group: int) -> str:
    return f"{ids.VERTEX_WEIGHT}_{group}"


@contextmanager
def _copying(pairs: Sequence[tuple[str, str]]) -> Iterator[Adjust | None]:
    """Of attributes or groups to others, by name."""
    if not pairs:
        yield None
        return
    group = bpy.data.node_groups.new(ids.WEIGHTS_GROUP, "GeometryNodeTree")
    _fill(group, pairs)

    def add_nodes(copy: bpy.types.Object, _scene: bpy.types.Scene) -> None:
        copy.modifiers.new(group.name, "NODES").node_group = group

    try:
        yield add_nodes
    finally:
        bpy.data.node_groups.remove(group)


def _fill(group: bpy.types.NodeTree, pairs: Sequence[tuple[str, str]]) -> None:
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    nodes, links = group.nodes, group.links
    geometry = nodes.new("NodeGroupInput").outputs["Geometry"]
    for source, target in pairs:
        weight = nodes.new("GeometryNodeInputNamedAttribute")
        weight.data_type = "FLOAT"
        weight.inputs["Name"].default_value = source
        store = nodes.new("GeometryNodeStoreNamedAttribute")
        store.data_type, store.domain = "FLOAT", "POINT"
        store.inputs["Name"].default_value = target
        links.new(weight.outputs["Attribute"], store.inputs["Value"])
        links.new(geometry, store.inputs["Geometry"])
        geometry = store.outputs["Geometry"]
    links.new(geometry, nodes.new("NodeGroupOutput").inputs["Geometry"])
