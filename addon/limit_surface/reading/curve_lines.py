# SPDX-License-Identifier: GPL-3.0-or-later
"""The straight lines that evaluated curves consist of, whatever their type and resolution.

Geometry Nodes, run in the evaluation of an empty mesh, turn Curve and hair objects into edges. What
thickens Curve objects is switched off on a copy of them: nodes would get the thick mesh.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from . import attributes, cage, copied_object, transform

TYPES = {"CURVE", "CURVES"}


def read(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray:
    """Returns the ends (n, 2, 3) of all lines in the world, each from the side of the curve's first
    point. Raises RefusalError where there are none, and where coordinates are not finite numbers.
    """
    if ob.type not in TYPES:
        raise RefusalError(f"{ob.name} is neither a curve object nor hair")
    tree = bpy.data.node_groups.new(ids.LINES_GROUP, "GeometryNodeTree")
    mesh = bpy.data.meshes.new(ids.TEMPORARY_MESH)
    empty = bpy.data.objects.new(ids.TEMPORARY_MESH, mesh)
    try:
        with _thin(ob) as thin:
            lines = _evaluated(cage.Subject(thin, ob), tree, empty, depsgraph)
    finally:
        bpy.data.objects.remove(empty)
        bpy.data.meshes.remove(mesh)
        bpy.data.node_groups.remove(tree)
    if not len(lines):
        raise RefusalError(f"{ob.name} has no curves")
    if not np.isfinite(lines).all():
        raise RefusalError(f"{ob.name} has coordinates that are not finite numbers")
    matrix = np.array(ob.evaluated_get(depsgraph).matrix_world, np.float64)
    transform.check_finite(matrix, ob.name)
    return lines @ matrix[:3, :3].T + matrix[:3, 3]


def joined(lines: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns lines (n, 2, 3) as curves: their points (m, 3), and the offsets (k + 1,) of each
    one's points. A line that begins where the one before ends continues its curve.
    """
    begins = np.ones(len(lines), bool)
    begins[1:] = (lines[1:, 0] != lines[:-1, 1]).any(axis=1)
    keeps = np.ones((len(lines), 2), bool)
    keeps[:, 0] = begins
    sizes = keeps.sum(axis=1)
    return lines[keeps], np.append((np.cumsum(sizes) - sizes)[begins], sizes.sum())


@contextmanager
def _thin(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Yields the object, or for a Curve object a copy without bevel, extrusion and filling."""
    if ob.type != "CURVE":
        yield ob
        return
    thin, data = copied_object.of(ob), ob.data.copy()
    try:
        thin.data = data
        data.bevel_mode, data.bevel_depth, data.bevel_object, data.extrude = "ROUND", 0, None, 0
        data.fill_mode = "NONE" if data.dimensions == "2D" else "FULL"
        yield thin
    finally:
        bpy.data.objects.remove(thin)
        bpy.data.curves.remove(data)


def _evaluated(
    subject: cage.Subject,
    tree: bpy.types.NodeTree,
    empty: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
) -> np.ndarray:
    _fill(tree, subject.copy)

    def add_nodes(copy: bpy.types.Object, _scene: bpy.types.Scene) -> None:
        copy.modifiers.new(tree.name, "NODES").node_group = tree

    with cage.evaluated_copy(empty, 0, depsgraph, add_nodes, subject=subject) as evaluated:
        return _edges(evaluated.data)


def _fill(tree: bpy.types.NodeTree, ob: bpy.types.Object) -> None:
    for in_out in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    info = tree.nodes.new("GeometryNodeObjectInfo")
    info.transform_space = "ORIGINAL"
    info.inputs["Object"].default_value = ob
    # Blender does not notice all changes of attributes that alter the number of evaluated points.
    # This node, which selects no curve, has it count them anew (`nodes/follow.py` says more).
    counted = tree.nodes.new("GeometryNodeSetSplineCyclic")
    counted.inputs["Selection"].default_value = False
    to_mesh = tree.nodes.new("GeometryNodeCurveToMesh")
    output = tree.nodes.new("NodeGroupOutput")
    tree.links.new(info.outputs["Geometry"], counted.inputs[0])
    tree.links.new(counted.outputs[0], to_mesh.inputs["Curve"])
    tree.links.new(to_mesh.outputs["Mesh"], output.inputs["Geometry"])


def _edges(mesh: bpy.types.Mesh) -> np.ndarray:
    """Returns the ends (n, 2, 3) of all edges. The points of a curve follow one another, and the
    last edge of a closed curve, which leads back to its first point, is the only one whose ends are
    not neighbours.
    """
    if not len(mesh.edges):
        return np.empty((0, 2, 3))
    ends = np.sort(attributes.read(mesh, ids.EDGE_VERTICES), axis=1)
    closes = ends[:, 1] - ends[:, 0] > 1
    ends[closes] = ends[closes][:, ::-1]
    return attributes.read(mesh, ids.POSITION).astype(np.float64)[ends]
