# SPDX-License-Identifier: GPL-3.0-or-later
"""The groups whose modifiers move things with the limit surface: *Limit Hair* for strands, *Limit
Follow* for points and vertices.

A point p goes to P + Q (p - rest_root), where P is the place of its root in this frame, and Q the
rotation from the root's frame at rest to the frame there now.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy

from .. import ids
from .groups import Kind
from .sample import SAMPLE
from .tree import Socket, Tree, Value

#: Names of the inputs
SURFACE, TILES = "Surface", "Tiles"


class Roots(NamedTuple):
    """The attributes that bind things to the surface, as fields."""

    tile: Value
    tile_uv: Value
    rest: Value
    rest_rotation: Value


class Carried(NamedTuple):
    """Geometry on which the place and the turn of each root are known."""

    geometry: Value
    rest: Value
    place: Value
    turn: Value
    fits: Value  # whether the tables fit the surface

    def moved(self, tree: Tree, point: Value) -> Value:
        """Returns where a point goes that is given at rest."""
        offset = tree.vector("SUBTRACT", point, self.rest)
        offset = tree.get("FunctionNodeRotateVector", offset, self.turn)
        return tree.vector("ADD", self.place, offset)


def new_tree(name: str, what: str, *more: Socket) -> Tree:
    """Begins the group of a modifier that moves such things."""
    return Tree(
        name,
        [
            Socket("Geometry", "Geometry", f"{what} at rest"),
            Socket(SURFACE, "Object", "Mesh to follow, which has the modifier Limit Capture"),
            Socket(TILES, "Object", "Hidden object that holds the tiles of its limit surface"),
            *more,
        ],
        [Socket("Geometry", "Geometry", f"{what} on the surface as it is in this frame")],
        is_modifier=True,
    )


def own_roots(tree: Tree) -> Roots:
    """Returns the attributes of the things themselves."""
    return Roots(
        tree.attribute(ids.TILE, "INT"),
        tree.attribute(ids.TILE_UV, "FLOAT_VECTOR"),
        tree.attribute(ids.REST_ROOT, "FLOAT_VECTOR"),
        tree.attribute(ids.REST_ROTATION, "QUATERNION"),
    )


def carried(tree: Tree, geometry: Value, domain: str, roots: Roots) -> Carried:
    """Finds the place and the turn of each element of the domain. Elements that belong to no tile
    have been added later, and stay where they are.
    """
    on_surface = tree.group_node(
        SAMPLE.group(),
        Surface=tree.inputs[SURFACE],
        Tiles=tree.inputs[TILES],
        Tile=tree.math("SUBTRACT", roots.tile, 1.0),
        Tile_UV=roots.tile_uv,
    )
    follows = tree.compare("GREATER_THAN", roots.tile, 0)
    from_rest = tree.get("FunctionNodeInvertRotation", roots.rest_rotation)
    turn = tree.get(
        "FunctionNodeRotateRotation", on_surface["Rotation"], from_rest, rotation_space="LOCAL"
    )
    # Without the capture these would be evaluated for each point of a strand.
    captured = tree.capture(
        geometry,
        domain,
        Place=("VECTOR", tree.switch(follows, roots.rest, on_surface["Position"], "VECTOR")),
        Turn=("ROTATION", tree.switch(follows, (0.0, 0.0, 0.0), turn, "ROTATION")),
    )
    fits = on_surface["Fits"]
    tree.warn(
        tree.negated(fits),
        "The faces or creases of the surface have changed: run Rebind to Limit Surface. Creases "
        "that are animated need the mode Live of Follow Limit Surface",
    )
    return Carried(captured[0], roots.rest, captured["Place"], captured["Turn"], fits)


def finished(tree: Tree, on: Carried, moved: Value) -> bpy.types.NodeTree:
    """Ends the group: what does not fit stays at rest."""
    return tree.finish(Geometry=tree.switch(on.fits, tree.inputs["Geometry"], moved, "GEOMETRY"))


def with_handles(tree: Tree, on: Carried) -> Value:
    """Returns curves whose points and Bézier handles are moved. Where a point is moved alone, its
    handles are shifted with it but not turned.
    """
    handles = tree.node("GeometryNodeInputCurveHandlePositions").outputs
    before = tree.capture(
        on.geometry,
        "POINT",
        Left=("VECTOR", on.moved(tree, handles["Left"])),
        Right=("VECTOR", on.moved(tree, handles["Right"])),
    )
    moved = tree.set_position(before[0], True, on.moved(tree, tree.position()))
    for side in ("Left", "Right"):
        moved = tree.get(
            "GeometryNodeSetCurveHandlePositions", moved, True, before[side], mode=side.upper()
        )
    return moved


def _counted_anew(tree: Tree) -> Value:
    """Returns the strands as they are, and has Blender count anew the points that it evaluates on
    them.

    Blender keeps these counts. It does not notice when a script writes the attributes cyclic or
    resolution, or when somebody gives an attribute one of these names, and then it writes beyond
    the end of its memory as soon as the strands have been moved. The node forgets the counts. No
    strand is selected, so that none changes.
    """
    return tree.get("GeometryNodeSetSplineCyclic", tree.inputs["Geometry"], False, False)


def _build_hair() -> bpy.types.NodeTree:
    tree = new_tree(ids.FOLLOW_HAIR_GROUP, "Hair")
    on = carried(tree, _counted_anew(tree), "CURVE", own_roots(tree))
    return finished(tree, on, tree.set_position(on.geometry, True, on.moved(tree, tree.position())))


def _build_bezier_hair() -> bpy.types.NodeTree:
    tree = new_tree(ids.FOLLOW_BEZIER_GROUP, "Hair with Bézier strands")
    on = carried(tree, _counted_anew(tree), "CURVE", own_roots(tree))
    return finished(tree, on, with_handles(tree, on))


def _points(name: str, what: str) -> tuple[Tree, Carried, Value]:
    tree = new_tree(name, what)
    on = carried(tree, tree.inputs["Geometry"], "POINT", own_roots(tree))
    moved = tree.set_position(on.geometry, True, on.moved(tree, tree.position()))
    return tree, on, moved


def _build_points() -> bpy.types.NodeTree:
    return finished(*_points(ids.FOLLOW_POINTS_GROUP, "Points or vertices"))


def _build_oriented_points() -> bpy.types.NodeTree:
    what = "Points with the attributes normal, tangent, rotation"
    tree, on, moved = _points(ids.FOLLOW_ORIENTED_GROUP, what)
    for name in (ids.NORMAL, ids.TANGENT):
        vector = tree.attribute(name, "FLOAT_VECTOR")
        turned = tree.get("FunctionNodeRotateVector", vector, on.turn)
        moved = tree.store(moved, name, turned, "FLOAT_VECTOR")
    rotation = tree.attribute(ids.ROTATION, "QUATERNION")
    turned = tree.get("FunctionNodeRotateRotation", rotation, on.turn, rotation_space="GLOBAL")
    return finished(tree, on, tree.store(moved, ids.ROTATION, turned, "QUATERNION"))


def _build_normals() -> bpy.types.NodeTree:
    what = "Mesh with custom normals that are vectors"
    tree, on, moved = _points(ids.FOLLOW_NORMALS_GROUP, what)
    normal = tree.attribute(ids.CUSTOM_NORMAL, "FLOAT_VECTOR")
    turned = tree.get("FunctionNodeRotateVector", normal, on.turn)
    return finished(
        tree, on, tree.store(moved, ids.CUSTOM_NORMAL, turned, "FLOAT_VECTOR", "CORNER")
    )


FOLLOW_HAIR = Kind(ids.FOLLOW_HAIR_GROUP, 3, _build_hair)
FOLLOW_BEZIER = Kind(ids.FOLLOW_BEZIER_GROUP, 3, _build_bezier_hair)
FOLLOW_POINTS = Kind(ids.FOLLOW_POINTS_GROUP, 2, _build_points)
FOLLOW_ORIENTED = Kind(ids.FOLLOW_ORIENTED_GROUP, 2, _build_oriented_points)
FOLLOW_NORMALS = Kind(ids.FOLLOW_NORMALS_GROUP, 2, _build_normals)
