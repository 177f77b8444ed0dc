# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Sample Limit Tile*: position and frame of the limit surface at places in tiles."""

import bpy

from .. import ids
from . import tiles
from .groups import Kind
from .tree import Socket, Tree, Value

# Derivatives are multiplied by it, because the product of two derivatives in a tile of 2^-20 of a
# face would be too short to have a direction in single precision.
_MAGNIFIED = 4096.0

_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

TILE = Socket(
    "Tile",
    "Int",
    "Number of the tile, counted from 0: connect the output Tile of Locate Limit Tile. A tile is a "
    "small part of the limit surface",
)
TILE_UV = Socket(
    "Tile UV",
    "Vector",
    "Place in that tile: X and Y from 0 to 1, as the output Tile UV of Locate Limit Tile gives it",
)

OUTPUTS = (
    Socket("Position", "Vector", "The place's point on the limit surface in this frame"),
    Socket("Normal", "Vector", "Direction straight out of the surface; its length is 1"),
    Socket(
        "Tangent",
        "Vector",
        "Direction along the surface in which the X of UV grows; its length is 1",
    ),
    Socket("Rotation", "Rotation", "Rotation that turns X to the tangent and Z to the normal"),
    Socket(
        "du", "Vector", "How fast Position changes while the X of UV grows: its derivative by X"
    ),
    Socket(
        "dv", "Vector", "How fast Position changes while the Y of UV grows: its derivative by Y"
    ),
    Socket(
        "Fits",
        "Bool",
        "False if the mesh has other faces or creases than when the table Tiles was made, so that "
        "the other outputs are of no use: make the table again",
    ),
)


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.SAMPLE_TILE_GROUP,
        [
            Socket("Surface", "Object", "Mesh object, which has the modifier Limit Capture"),
            Socket(
                "Tiles",
                "Object",
                "Hidden object that holds the tiles of that mesh's limit surface: Limit Tiles or "
                "Limit All Tiles, and the mesh's name",
            ),
            TILE,
            TILE_UV,
        ],
        list(OUTPUTS),
    )
    table = tree.object_info(tree.inputs["Tiles"])["Geometry"]
    first = tree.math("MULTIPLY", tree.inputs["Tile"], float(tiles.ROWS_OF_A_TILE))
    position, du, dv = _in_tile(tree, table, first)

    # from the surface's space to that of the object whose modifier this is
    matrix = _relation(tree)
    du, dv = (tree.mapped_direction(derivative, matrix) for derivative in (du, dv))
    # Next to a vertex with two faces both derivatives become so short that their product would have
    # no direction in single precision.
    along_u, along_v = (tree.vector("NORMALIZE", derivative) for derivative in (du, dv))
    normal = tree.vector("CROSS_PRODUCT", along_u, along_v)
    normal = tree.scaled(normal, _handedness(tree, matrix))
    rotation = tree.get(
        "FunctionNodeAxesToRotation", normal, along_u, primary_axis="Z", secondary_axis="X"
    )
    scale = tree.components(
        tree.sample(table, tree.attribute(tiles.SCALE, "FLOAT_VECTOR"), first, "FLOAT_VECTOR")
    )
    fits = tree.sample(table, tree.attribute(ids.CAGE_FITS, "INT"), 0, "INT")
    return tree.finish(
        Position=tree.mapped_point(position, matrix),
        Normal=tree.vector("NORMALIZE", normal),
        Tangent=along_u,
        Rotation=rotation,
        du=tree.scaled(du, tree.math("DIVIDE", scale[0], _MAGNIFIED)),
        dv=tree.scaled(dv, tree.math("DIVIDE", scale[1], _MAGNIFIED)),
        Fits=tree.compare("EQUAL", fits, 1),
    )


def _in_tile(tree: Tree, table: Value, first: Value) -> tuple[Value, Value, Value]:
    """Returns the position, and the magnified derivatives by the place in the tile, in the
    surface's space. `first` is the table's vertex that holds row 0 of the tile.
    """
    uv = tree.inputs["Tile UV"]
    square = tree.vector("MULTIPLY", uv, uv)
    (u, v, _), (u2, v2, _) = tree.components(uv), tree.components(square)
    u3, v3, _ = tree.components(tree.vector("MULTIPLY", square, uv))
    du, dv, _ = tree.components(tree.scaled(uv, 2 * _MAGNIFIED))
    du2, dv2, _ = tree.components(tree.scaled(square, 3 * _MAGNIFIED))
    powers_u, powers_v = tree.combined(u, u2, u3), tree.combined(v, v2, v3)
    slopes_u, slopes_v = (
        tree.combined(_MAGNIFIED, once, twice) for once, twice in ((du, du2), (dv, dv2))
    )
    # the weights of rows 1 to 3, as polynomials in u
    weights = tree.matrix(
        (0.0, 0.5, 0.0), (-1.0, 0.5, 0.0), (0.5, -0.5, 1 / 6), (2 / 3, 1 / 6, 0.0)
    )
    weight = tree.components(tree.mapped_point(powers_u, weights))
    slope = tree.components(tree.mapped_direction(slopes_u, weights))

    field = tree.attribute(ids.TILE_MATRIX, "FLOAT4X4")
    matrices = [
        tree.sample(table, field, tree.math("ADD", first, float(x)), "FLOAT4X4")
        for x in range(tiles.ROWS_OF_A_TILE)
    ]
    rows = [tree.mapped_point(powers_v, matrix) for matrix in matrices]
    slopes = [tree.mapped_direction(slopes_v, matrix) for matrix in matrices]
    position, by_v = rows[0], slopes[0]
    by_u: Value = (0.0, 0.0, 0.0)
    for x in range(3):
        position = tree.scaled_plus(rows[x + 1], weight[x], position)
        by_u = tree.scaled_plus(rows[x + 1], slope[x], by_u)
        by_v = tree.scaled_plus(slopes[x + 1], weight[x], by_v)
    return position, by_u, by_v


def _relation(tree: Tree) -> Value:
    """Returns the matrix from the surface's space to that of the object whose modifier this is.
    Where both have the same transform it is exactly the identity: far from the world's origin,
    Blender's own relative matrix has lost digits.
    """
    surface = tree.inputs["Surface"]
    relative = tree.object_info(surface, "RELATIVE")["Transform"]
    own = tree.object_info(tree.get("GeometryNodeSelfObject"))["Transform"]
    theirs = tree.object_info(surface)["Transform"]
    same: Value = True
    for axis in _AXES:
        same = tree.both(
            same, _are_equal(tree, *(tree.mapped_direction(axis, m) for m in (own, theirs)))
        )
    origins = (tree.mapped_point((0.0, 0.0, 0.0), m) for m in (own, theirs))
    same = tree.both(same, _are_equal(tree, *origins))
    identity = tree.matrix(*_AXES, (0.0, 0.0, 0.0))
    return tree.switch(same, relative, identity, "MATRIX")


def _are_equal(tree: Tree, a: Value, b: Value) -> Value:
    """Tells whether two vectors have the same components."""
    difference = tree.node("ShaderNodeVectorMath", a, b, operation="DISTANCE").outputs["Value"]
    return tree.negated(tree.math("GREATER_THAN", difference, 0.0))


def _handedness(tree: Tree, matrix: Value) -> Value:
    """Returns 1, or -1 for a matrix that mirrors."""
    x, y, z = (tree.mapped_direction(axis, matrix) for axis in _AXES)
    volume = tree.node(
        "ShaderNodeVectorMath", tree.vector("CROSS_PRODUCT", x, y), z, operation="DOT_PRODUCT"
    ).outputs["Value"]
    return tree.math("SIGN", volume)


SAMPLE = Kind(ids.SAMPLE_TILE_GROUP, 1, _build)
