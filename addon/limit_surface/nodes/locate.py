# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Locate Limit Tile*: from (face, u, v) to the tile there, by the quadtrees that a table
of all tiles holds.
"""

import bpy

from .. import ids
from . import tiles
from .groups import Kind
from .tree import Socket, Tree

# Attributes of a table of all tiles. Vertex i holds node i of the quadtrees; the first nodes are
# the faces. `child` is the first of a node's four children, or -1 - tile.
CHILD = "child"
ORIGIN = "tile_origin"  # of each tile's first vertex: where it begins on its face
LEVELS, FACES = "levels", "faces"  # the same on all vertices


ALL_TILES = Socket(
    "Tiles",
    "Object",
    "Hidden object that holds all tiles of the mesh's limit surface: Limit All Tiles, and the "
    "mesh's name. The operator Tables for Sample Limit Surface makes it",
)
FACE = Socket(
    "Face",
    "Int",
    "Number of a quad of the mesh, or of one corner's part of another face, counted from 0 in the "
    "order of the mesh's faces: a triangle counts as 3, for example. What the extension makes has "
    "it as the attribute limit_face",
)
UV = Socket(
    "UV",
    "Vector",
    "Place on that quad or part: X and Y from 0 to 1. (0, 0) is the quad's first corner, (1, 0) "
    "its second and (0, 1) its last; on a part, (0, 0) is the corner and (1, 1) the middle of the "
    "face. What the extension makes has it as the attribute limit_uv",
)


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.LOCATE_GROUP,
        [
            ALL_TILES,
            FACE,
            UV,
        ],
        [
            Socket(
                "Tile",
                "Int",
                "Number of the tile of the limit surface that holds the place, counted from 0. "
                "It is for the input Tile of Sample Limit Surface",
            ),
            Socket("Tile UV", "Vector", "Place in that tile: X and Y from 0 to 1"),
            Socket(
                "Found", "Bool", "False if the mesh has no such face, or no limit surface on it"
            ),
        ],
    )
    table = tree.object_info(tree.inputs["Tiles"])["Geometry"]
    child = tree.attribute(CHILD, "INT")
    levels, faces = (
        tree.sample(table, tree.attribute(name, "INT"), 0, "INT") for name in (LEVELS, FACES)
    )
    now, then, done = tree.repeat(
        levels, Node=("INT", tree.inputs["Face"]), Rest=("VECTOR", tree.inputs["UV"])
    )
    below = tree.sample(table, child, now["Node"], "INT")
    splits = tree.compare("GREATER_EQUAL", below, 0)
    double = tree.scaled(now["Rest"], 2.0)
    upper = tree.vector("MINIMUM", tree.vector("FLOOR", double), (1.0, 1.0, 1.0))
    x, y, _ = tree.components(upper)
    chosen = tree.math("ADD", below, tree.math("MULTIPLY_ADD", y, 2.0, x))
    tree.set(then["Node"], tree.switch(splits, now["Node"], chosen, "INT"))
    rest = tree.vector("SUBTRACT", double, upper)
    tree.set(then["Rest"], tree.switch(splits, now["Rest"], rest, "VECTOR"))

    tile = tree.math("SUBTRACT", -1.0, tree.sample(table, child, done["Node"], "INT"))
    first = tree.math("MULTIPLY", tile, float(tiles.ROWS_OF_A_TILE))
    origin, scale = (
        tree.sample(table, tree.attribute(name, "FLOAT_VECTOR"), first, "FLOAT_VECTOR")
        for name in (ORIGIN, tiles.SCALE)
    )
    in_tile = tree.vector("MULTIPLY", tree.vector("SUBTRACT", tree.inputs["UV"], origin), scale)
    inside = tree.vector("MAXIMUM", in_tile, (0.0, 0.0, 0.0))
    count = tree.get("GeometryNodeAttributeDomainSize", table, component="MESH")
    is_face = tree.both(
        tree.compare("GREATER_EQUAL", tree.inputs["Face"], 0),
        tree.compare("LESS_THAN", tree.inputs["Face"], faces),
    )
    return tree.finish(
        Tile=tile,
        Tile_UV=tree.vector("MINIMUM", inside, (1.0, 1.0, 1.0)),
        Found=tree.both(is_face, tree.compare("LESS_THAN", first, count)),
    )


LOCATE = Kind(ids.LOCATE_GROUP, 1, _build)
