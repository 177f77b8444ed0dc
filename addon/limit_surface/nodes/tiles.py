# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Limit Tiles*: in each frame it makes four matrices for each bicubic tile.

Row x of a tile's control points (x counts along u, from 0 to 3) is a cubic curve in v. Its matrix
maps (v, v^2, v^3) to the curve's point. Row 0 is a place in space, the other rows are relative to
row 0, so that small tiles keep their digits in single precision.
"""

import bpy

from .. import ids
from .groups import Kind
from .tree import Socket, Tree, Value

# Attributes of the table of points. `row` is the refined point that a vertex belongs to, and `k0`
# to `k2` are vertices of the control mesh. A vertex that holds the terms of a refined point's sum
# has their three weights as its position. A refined point's own vertex has in `k0` the vertex that
# the others of its sum are relative to, and in `k1` the sum of the weights, 0 or 1.
ROW = "row"
TERMS = ("k0", "k1", "k2")

# Attributes of the table of tiles, four vertices for each tile: the points of a row of control
# points, the points that these are relative to, and the point that the row itself is relative to.
CONTROL = ("c0", "c1", "c2", "c3")
BASE = ("b0", "b1", "b2", "b3")
ANCHOR = "anchor"
SCALE = "tile_scale"  # factors that turn derivatives by the place in the tile into du and dv

ROWS_OF_A_TILE = 4

GUARDS_CREASES = "Guard Creases"  # the name of an input, which tables of older versions lack


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.TILES_GROUP,
        [
            Socket("Geometry", "Geometry", "Patches of a limit surface, as rows of a table"),
            Socket("Surface", "Object", "Mesh object, which has the modifier Limit Capture"),
            Socket("Points", "Object", "Hidden object that holds the points of the tiles"),
            Socket("Cage Count", "Int", "Number of the mesh's vertices when the table was made"),
            Socket("Cage Topology", "Int", "Checksum of its edges, to notice changes"),
            Socket("Refined Points", "Int", "Number of points that are weighted sums of vertices"),
            Socket("Use Proxy", "Bool", "Read the proxy instead of the surface in the viewport"),
            Socket("Proxy", "Object", "Copy of the surface that ends at Limit Capture"),
            Socket(GUARDS_CREASES, "Bool", "Whether creases of the mesh count"),
            Socket("Cage Edge Creases", "Int", "Checksum of creases of edges, to notice changes"),
            Socket(
                "Cage Vertex Creases",
                "Int",
                "Checksum of the creases of vertices, to notice changes",
            ),
        ],
        [Socket("Geometry", "Geometry", "The table, with the shapes of the tiles in this frame")],
        is_modifier=True,
    )
    by_proxy = tree.both(tree.get("GeometryNodeIsViewport"), tree.inputs["Use Proxy"])
    source = tree.switch(by_proxy, tree.inputs["Surface"], tree.inputs["Proxy"], "OBJECT")
    cage = tree.object_info(source)["Geometry"]
    points = _placed_points(tree, cage)
    matrix = _row_matrix(tree, points)
    table = tree.store(tree.inputs["Geometry"], ids.TILE_MATRIX, matrix, "FLOAT4X4")
    same_count, same_topology, same_edge_creases, same_vertex_creases = (
        tree.compare(
            "EQUAL", tree.sample(cage, tree.attribute(name, "INT"), 0, "INT"), tree.inputs[bound]
        )
        for name, bound in (
            (ids.CAGE_COUNT, "Cage Count"),
            (ids.CAGE_TOPOLOGY, "Cage Topology"),
            (ids.CAGE_EDGE_CREASES, "Cage Edge Creases"),
            (ids.CAGE_VERTEX_CREASES, "Cage Vertex Creases"),
        )
    )
    same_creases = tree.either(
        tree.both(same_edge_creases, same_vertex_creases),
        tree.negated(tree.inputs[GUARDS_CREASES]),
    )
    fits = tree.both(tree.both(same_count, same_topology), same_creases)
    # without the table of points all tiles would lie at the origin
    count = tree.get("GeometryNodeAttributeDomainSize", points, component="MESH")
    fits = tree.both(fits, tree.compare("GREATER_THAN", count, tree.inputs["Cage Count"]))
    return tree.finish(Geometry=tree.store(table, ids.CAGE_FITS, fits, "INT"))


def _placed_points(tree: Tree, cage: Value) -> Value:
    """Returns the table of points with all points where they are in this frame."""
    rows = tree.object_info(tree.inputs["Points"])["Geometry"]
    vertices, here = tree.inputs["Cage Count"], tree.index()
    on_cage = tree.attribute(ids.CAGE_POSITION, "FLOAT_VECTOR")

    row = tree.attribute(ROW, "INT")
    own = tree.sample(rows, tree.attribute(TERMS[0], "INT"), tree.math("ADD", vertices, row), "INT")
    base = tree.sample(cage, on_cage, own, "FLOAT_VECTOR")
    terms: Value = (0.0, 0.0, 0.0)
    for name, weight in zip(TERMS, tree.components(tree.position()), strict=True):
        point = tree.sample(cage, on_cage, tree.attribute(name, "INT"), "FLOAT_VECTOR")
        terms = tree.scaled_plus(tree.vector("SUBTRACT", point, base), weight, terms)
    summed = tree.node("GeometryNodeAccumulateField", data_type="FLOAT_VECTOR", domain="POINT")
    inputs = {socket.name: socket for socket in summed.inputs if socket.enabled}
    tree.set(inputs["Value"], terms)
    tree.set(inputs["Group ID"] if "Group ID" in inputs else inputs["Group Index"], row)
    total = next(s for s in summed.outputs if s.enabled and s.name == "Total")

    is_vertex = tree.compare("LESS_THAN", here, vertices)
    end = tree.math("ADD", vertices, tree.inputs["Refined Points"])
    is_refined = tree.both(tree.negated(is_vertex), tree.compare("LESS_THAN", here, end))
    refined = tree.scaled_plus(base, tree.attribute(TERMS[1], "INT"), total)
    # The sums need the weights, which are positions: they are moved first.
    rows = tree.set_position(rows, is_refined, refined)
    at_vertex = tree.sample(cage, on_cage, here, "FLOAT_VECTOR")
    return tree.set_position(rows, tree.compare("LESS_THAN", here, vertices), at_vertex)


def _row_matrix(tree: Tree, points: Value) -> Value:
    """Returns the matrix of each row: its uniform B-spline as powers of v."""

    def point(name: str) -> Value:
        return tree.sample(points, tree.position(), tree.attribute(name, "INT"), "FLOAT_VECTOR")

    e = [tree.vector("SUBTRACT", point(c), point(b)) for c, b in zip(CONTROL, BASE, strict=True)]
    constant = tree.vector("ADD", tree.scaled_plus(e[1], 4.0, e[0]), e[2])
    linear = tree.vector("SUBTRACT", e[2], e[0])
    square = tree.vector(
        "ADD", tree.vector("SUBTRACT", e[0], e[1]), tree.vector("SUBTRACT", e[2], e[1])
    )
    cube = tree.scaled_plus(
        tree.vector("SUBTRACT", e[1], e[2]), 3.0, tree.vector("SUBTRACT", e[3], e[0])
    )
    return tree.matrix(
        tree.scaled(linear, 1 / 2),
        tree.scaled(square, 1 / 2),
        tree.scaled(cube, 1 / 6),
        tree.scaled_plus(constant, 1 / 6, point(ANCHOR)),
    )


TILES = Kind(ids.TILES_GROUP, 2, _build)
