# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Limit Capture*: hands the control mesh on to what follows the surface.

Its modifier stands directly before the Subdivision Surface modifier. That keeps the control mesh's
vertices first, and hands on what is stored on them unchanged. Checksums tell whether the topology
or the creases have changed.
"""

import bpy
import numpy as np

from .. import ids
from .groups import Kind
from .tree import Socket, Tree, Value

# The product of two remainders is exact in single precision, in which nodes calculate. Sums of the
# products' remainders are below 2^31 for a million edges. Two pairs of divisors tell all numbers of
# vertices below 4093 * 4079 from each other.
_DIVISORS = ((4093, 1021), (4079, 1019))
# Whole numbers up to this are exact as well.
_CREASE_STEPS = 1 << 23

CHECKSUMS = (ids.CAGE_COUNT, ids.CAGE_TOPOLOGY, ids.CAGE_EDGE_CREASES, ids.CAGE_VERTEX_CREASES)
#: The attributes that the group stores at the vertices, and their types
STORED = {ids.CAGE_POSITION: "FLOAT_VECTOR", **dict.fromkeys(CHECKSUMS, "INT")}


def topology_sum(edges: np.ndarray) -> int:
    """Returns a checksum of edges (e, 2), given by their vertices: the one that the group
    calculates. It is different if the vertices' order differs.
    """
    first, second = (edges.astype(np.float64) + 1).T
    return _sum(first, second)


def crease_sum(creases: np.ndarray) -> int:
    """Returns a checksum of the creases of all edges or all vertices, in their order: the one that
    the group calculates.
    """
    return _sum(1.0 + np.arange(len(creases)), np.floor(creases.astype(np.float64) * _CREASE_STEPS))


def _sum(first: np.ndarray, second: np.ndarray) -> int:
    """Returns the checksum of pairs of whole numbers. Remainders have the sign of the number, as
    those of the nodes do.
    """
    total: np.ndarray = np.zeros(len(first))
    for divisor, small_divisor in _DIVISORS:
        product = np.fmod(first, divisor) * np.fmod(second, divisor)
        total += np.fmod(product, small_divisor)
    return int(total.astype(np.int64).sum().astype(np.int32))


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.CAPTURE_GROUP,
        [Socket("Geometry", "Geometry", "Mesh before it is subdivided (control mesh)")],
        [Socket("Geometry", "Geometry", "The same mesh, with its positions as an attribute")],
        is_modifier=True,
    )
    mesh = tree.inputs["Geometry"]
    count = tree.get("GeometryNodeAttributeDomainSize", mesh, component="MESH")
    ends = tree.node("GeometryNodeInputMeshEdgeVertices").outputs
    first, second = (tree.math("ADD", ends[k], 1.0) for k in range(2))
    here = tree.math("ADD", tree.index(), 1.0)
    kept = tree.store(mesh, ids.CAGE_POSITION, tree.position(), "FLOAT_VECTOR")
    kept = tree.store(kept, ids.CAGE_COUNT, count, "INT")
    for name, domain, a, b in (
        (ids.CAGE_TOPOLOGY, "EDGE", first, second),
        (ids.CAGE_EDGE_CREASES, "EDGE", here, _whole(tree, ids.EDGE_CREASE)),
        (ids.CAGE_VERTEX_CREASES, "POINT", here, _whole(tree, ids.VERTEX_CREASE)),
    ):
        kept = tree.store(kept, name, _summed(tree, mesh, domain, a, b), "INT")
    return tree.finish(Geometry=kept)


def _summed(tree: Tree, mesh: Value, domain: str, a: Value, b: Value) -> Value:
    """Returns the sum, over all elements of the mesh, of a product of two whole numbers."""
    products = []
    for divisor, small_divisor in _DIVISORS:
        first, second = (tree.math("MODULO", value, float(divisor)) for value in (a, b))
        product = tree.math("MULTIPLY", first, second)
        products.append(tree.math("MODULO", product, float(small_divisor)))
    summed = tree.node("GeometryNodeAccumulateField", data_type="INT", domain=domain)
    tree.set(next(s for s in summed.inputs if s.enabled), tree.math("ADD", *products))
    total = next(s for s in summed.outputs if s.enabled and s.name == "Total")
    return tree.sample(mesh, total, 0, "INT", domain)


def _whole(tree: Tree, crease: str) -> Value:
    """Returns creases, from 0 to 1, as whole numbers."""
    creases = tree.attribute(crease, "FLOAT")
    return tree.math("FLOOR", tree.math("MULTIPLY", creases, float(_CREASE_STEPS)))


CAPTURE = Kind(ids.CAPTURE_GROUP, 1, _build)
