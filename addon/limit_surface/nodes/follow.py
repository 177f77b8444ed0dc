# SPDX-License-Identifier: GPL-3.0-or-later
"""The groups whose modifiers move things with the limit surface: *Limit Hair* for strands, *Limit
Follow* for points and vertices.

A point p goes to P + Q (p - rest_root), where P is the place of its root in this frame, and Q the
rotation from the root's frame at rest to the frame there now.
"""

import bpy

from .. import ids
from .groups import Kind
from .sample import SAMPLE
from .tree import Socket, Tree, Value

#: Names of the inputs
SURFACE, TILES = "Surface", "Tiles"


def _build_hair() -> bpy.types.NodeTree:
    tree = _new(ids.FOLLOW_HAIR_GROUP, "Hair")
    geometry, place, turn, fits = _carried(tree, "CURVE")
    moved = tree.set_position(geometry, True, _moved(tree, tree.position(), place, turn))
    return tree.finish(Geometry=tree.switch(fits, tree.inputs["Geometry"], moved, "GEOMETRY"))


def _build_points() -> bpy.types.NodeTree:
    tree = _new(ids.FOLLOW_POINTS_GROUP, "Points or vertices")
    geometry, place, turn, fits = _carried(tree, "POINT")
    moved = tree.set_position(geometry, True, _moved(tree, tree.position(), place, turn))
    return tree.finish(Geometry=tree.switch(fits, tree.inputs["Geometry"], moved, "GEOMETRY"))


def _build_oriented_points() -> bpy.types.NodeTree:
    tree = _new(ids.FOLLOW_ORIENTED_GROUP, "Points with the attributes normal, tangent, rotation")
    geometry, place, turn, fits = _carried(tree, "POINT")
    moved = tree.set_position(geometry, True, _moved(tree, tree.position(), place, turn))
    for name in (ids.NORMAL, ids.TANGENT):
        vector = tree.attribute(name, "FLOAT_VECTOR")
        turned = tree.get("FunctionNodeRotateVector", vector, turn)
        moved = tree.store(moved, name, turned, "FLOAT_VECTOR")
    rotation = tree.attribute(ids.ROTATION, "QUATERNION")
    turned = tree.get("FunctionNodeRotateRotation", rotation, turn, rotation_space="GLOBAL")
    moved = tree.store(moved, ids.ROTATION, turned, "QUATERNION")
    return tree.finish(Geometry=tree.switch(fits, tree.inputs["Geometry"], moved, "GEOMETRY"))


def _new(name: str, what: str) -> Tree:
    return Tree(
        name,
        [
            Socket("Geometry", "Geometry", f"{what} at rest"),
            Socket(SURFACE, "Object", "Mesh to follow, which has the modifier Limit Capture"),
            Socket(TILES, "Object", "Table of tiles of that surface"),
        ],
        [Socket("Geometry", "Geometry", f"{what} on the surface as it is in this frame")],
        is_modifier=True,
    )


def _carried(tree: Tree, domain: str) -> tuple[Value, Value, Value, Value]:
    """Returns the geometry, for each element of the domain its place and its turn, and whether the
    tables fit the surface. Elements that belong to no tile have been added later, and stay where
    they are.
    """
    tile, rest = tree.attribute(ids.TILE, "INT"), tree.attribute(ids.REST_ROOT, "FLOAT_VECTOR")
    on_surface = tree.group_node(
        SAMPLE.group(),
        Surface=tree.inputs[SURFACE],
        Tiles=tree.inputs[TILES],
        Tile=tree.math("SUBTRACT", tile, 1.0),
        Tile_UV=tree.attribute(ids.TILE_UV, "FLOAT_VECTOR"),
    )
    follows = tree.compare("GREATER_THAN", tile, 0)
    from_rest = tree.get(
        "FunctionNodeInvertRotation", tree.attribute(ids.REST_ROTATION, "QUATERNION")
    )
    turn = tree.get(
        "FunctionNodeRotateRotation", on_surface["Rotation"], from_rest, rotation_space="LOCAL"
    )
    # Without the capture these would be evaluated for each point of a strand.
    captured = tree.capture(
        tree.inputs["Geometry"],
        domain,
        Place=("VECTOR", tree.switch(follows, rest, on_surface["Position"], "VECTOR")),
        Turn=("ROTATION", tree.switch(follows, (0.0, 0.0, 0.0), turn, "ROTATION")),
    )
    fits = on_surface["Fits"]
    tree.warn(tree.negated(fits), "The surface's control mesh has changed: bind again")
    return captured[0], captured["Place"], captured["Turn"], fits


def _moved(tree: Tree, point: Value, place: Value, turn: Value) -> Value:
    rest = tree.attribute(ids.REST_ROOT, "FLOAT_VECTOR")
    offset = tree.get("FunctionNodeRotateVector", tree.vector("SUBTRACT", point, rest), turn)
    return tree.vector("ADD", place, offset)


FOLLOW_HAIR = Kind(ids.FOLLOW_HAIR_GROUP, 1, _build_hair)
FOLLOW_POINTS = Kind(ids.FOLLOW_POINTS_GROUP, 1, _build_points)
FOLLOW_ORIENTED = Kind(ids.FOLLOW_ORIENTED_GROUP, 1, _build_oriented_points)
