# SPDX-License-Identifier: GPL-3.0-or-later
"""The weights of vertex groups as whole arrays, read from a mesh and written to one.

Python can access them only vertex by vertex. Geometry Nodes, run in the evaluation of a mesh, copy
them to attributes and back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial

import bpy
import numpy as np

from .. import ids
from . import attributes, cage

Adjust = Callable[[bpy.types.Object, bpy.types.Scene], None]

_MISSING = -1.0  # weights are from 0 to 1
# At each change of a tree Blender looks at all of its nodes, so one tree for all pairs would take
# quadratic time. Copies of a small tree take little more than their names.
_PAIRS_OF_A_TREE = 8
_SOURCE, _TARGET = "Source", "Target"


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
    used = np.flatnonzero(weights.any(axis=0))  # rigs have many groups without weights
    for i in used:
        attributes.write(mesh, _attribute(i), "FLOAT", "POINT", weights[:, i])
    ob = bpy.data.objects.new(ids.TEMPORARY_MESH, mesh)
    try:
        for group in groups:
            ob.vertex_groups.new(name=group)
        pairs = [(_attribute(i), groups[i]) for i in used]
        with (
            _copying(pairs) as add_nodes,
            cage.evaluated_copy(ob, 0, depsgraph, add_nodes) as evaluated,
        ):
            made = bpy.data.meshes.new_from_object(evaluated)
    finally:
        bpy.data.objects.remove(ob)
    for i in used:
        made.attributes.remove(made.attributes[_attribute(i)])
    return made


def _attribute(group: int) -> str:
    return f"{ids.VERTEX_WEIGHT}_{group}"


@contextmanager
def _copying(
    pairs: Sequence[tuple[str, str]], missing: float | None = None
) -> Iterator[Adjust | None]:
    """Makes node trees that copy attributes or groups to others, by name. A target whose source
    does not exist becomes `missing`, or 0.
    """
    if not pairs:
        yield None
        return
    trees = [_tree(min(len(pairs), _PAIRS_OF_A_TREE), missing)]
    try:
        starts = range(0, len(pairs), _PAIRS_OF_A_TREE)
        trees += [trees[0].copy() for _ in starts[1:]]
        for tree, start in zip(trees, starts, strict=True):
            _name(tree, pairs[start : start + _PAIRS_OF_A_TREE])
        yield partial(_add_modifiers, trees)
    finally:
        bpy.data.batch_remove(trees)


def _add_modifiers(
    trees: Sequence[bpy.types.NodeTree], copy: bpy.types.Object, _scene: bpy.types.Scene
) -> None:
    for tree in trees:
        copy.modifiers.new(tree.name, "NODES").node_group = tree


def _tree(pairs: int, missing: float | None) -> bpy.types.NodeTree:
    """Makes a tree for so many pairs, which have no names yet and copy nothing until then."""
    tree = bpy.data.node_groups.new(ids.WEIGHTS_GROUP, "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    nodes, links = tree.nodes, tree.links
    geometry = nodes.new("NodeGroupInput").outputs["Geometry"]
    for i in range(pairs):
        weight = nodes.new("GeometryNodeInputNamedAttribute")
        weight.name = f"{_SOURCE} {i}"
        weight.data_type = "FLOAT"
        value = weight.outputs["Attribute"]
        if missing is not None:
            known = nodes.new("GeometryNodeSwitch")
            known.input_type = "FLOAT"
            known.inputs["False"].default_value = missing
            links.new(weight.outputs["Exists"], known.inputs["Switch"])
            links.new(value, known.inputs["True"])
            value = known.outputs["Output"]
        store = nodes.new("GeometryNodeStoreNamedAttribute")
        store.name = f"{_TARGET} {i}"
        store.data_type, store.domain = "FLOAT", "POINT"
        links.new(value, store.inputs["Value"])
        links.new(geometry, store.inputs["Geometry"])
        geometry = store.outputs["Geometry"]
    links.new(geometry, nodes.new("NodeGroupOutput").inputs["Geometry"])
    return tree


def _name(tree: bpy.types.NodeTree, pairs: Sequence[tuple[str, str]]) -> None:
    for i, (source, target) in enumerate(pairs):
        tree.nodes[f"{_SOURCE} {i}"].inputs["Name"].default_value = source
        tree.nodes[f"{_TARGET} {i}"].inputs["Name"].default_value = target
