# SPDX-License-Identifier: GPL-3.0-or-later
"""The weights of a vertex group as a whole array.

Python sees them vertex by vertex only; geometry nodes, run for the evaluation of a mesh, copy them
to an attribute.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from .. import ids
from . import attributes

_MISSING = -1.0  # weights are 0 to 1


@contextmanager
def kept(
    vertex_group: str,
) -> Iterator[Callable[[bpy.types.Object, bpy.types.Scene], None] | None]:
    """Gives what is to be done to a copied object before it is evaluated, so that its mesh can be
    `read`; None for no name."""
    if not vertex_group:
        yield None
        return
    group = _make_nodes(vertex_group)

    def add_nodes(copy: bpy.types.Object, _scene: bpy.types.Scene) -> None:
        copy.modifiers.new(group.name, "NODES").node_group = group

    try:
        yield add_nodes
    finally:
        bpy.data.node_groups.remove(group)


def read(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """One for each vertex of a mesh that has kept them; None where modifiers drop the group."""
    values = attributes.read(mesh, ids.VERTEX_WEIGHT)
    return None if (values == _MISSING).all() else values


def _make_nodes(vertex_group: str) -> bpy.types.NodeTree:
    group = bpy.data.node_groups.new(ids.WEIGHTS_GROUP, "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    nodes, links = group.nodes, group.links
    inputs, outputs = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    weight = nodes.new("GeometryNodeInputNamedAttribute")
    weight.data_type = "FLOAT"
    weight.inputs["Name"].default_value = vertex_group
    known = nodes.new("GeometryNodeSwitch")
    known.input_type = "FLOAT"
    known.inputs["False"].default_value = _MISSING
    store = nodes.new("GeometryNodeStoreNamedAttribute")
    store.data_type, store.domain = "FLOAT", "POINT"
    store.inputs["Name"].default_value = ids.VERTEX_WEIGHT

    links.new(weight.outputs["Exists"], known.inputs["Switch"])
    links.new(weight.outputs["Attribute"], known.inputs["True"])
    links.new(known.outputs["Output"], store.inputs["Value"])
    links.new(inputs.outputs["Geometry"], store.inputs["Geometry"])
    links.new(store.outputs["Geometry"], outputs.inputs["Geometry"])
    return group
