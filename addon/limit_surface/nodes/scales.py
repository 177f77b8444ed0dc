# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Limit Scales*: a scale, as of a fish or a lizard, on each point."""

import math

import bpy

from .. import ids
from .groups import Kind, add_modifier
from .instances import placed
from .tree import Socket, Tree, Value

COLUMNS, ROWS = 9, 7  # vertices of a scale along and across
WIDTH = 0.8  # relative to the length
LIFT = math.radians(14)
BULGE = 0.12  # the height of the middle above the sides, relative to the width


def put_scales(points: bpy.types.Object, length: float) -> None:
    add_modifier(points, SCALES, Length=length, Width=WIDTH * length, Lift=LIFT)


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.SCALES_GROUP,
        [
            Socket("Geometry", "Geometry", "Points with the attributes rotation and scale"),
            Socket(
                "Length", "Float", "Length of the scales, from the point to the tip", "DISTANCE"
            ),
            Socket("Width", "Float", "Largest width of the scales", "DISTANCE"),
            Socket("Lift", "Float", "Angle by which the scales rise from the surface", "ANGLE"),
            Socket(
                "Turn", "Float", "Angle by which the scales are turned about the normal", "ANGLE"
            ),
            Socket("Material", "Material", "Material of the scales"),
        ],
        [Socket("Geometry", "Geometry", "Scales on the points")],
        is_modifier=True,
    )
    scale = tree.get("GeometryNodeMeshGrid", 1.0, 1.0, COLUMNS, ROWS)
    scale = tree.set_position(scale, True, _turned(tree, _position(tree)))
    scale = tree.get("GeometryNodeSetShadeSmooth", scale)
    scale = tree.get("GeometryNodeSetMaterial", scale, True, tree.inputs["Material"])
    return tree.finish(Geometry=placed(tree, scale).outputs["Instances"])


def _position(tree: Tree) -> list[Value]:
    """Returns where the vertices of a square belong on a scale that grows along X: narrow at the
    point, round at the tip, and bulging.
    """
    x, y, _z = tree.components(tree.position())
    along = tree.math("ADD", x, 0.5)  # 0 at the point, 1 at the tip
    across = tree.math("MULTIPLY", y, 2.0)  # -1 and 1 at the sides
    width, lift = tree.inputs["Width"], tree.inputs["Lift"]
    blunt = tree.math("SQRT", tree.math("SUBTRACT", 1.0, tree.math("POWER", along, 4.0)))
    taper = tree.math("MULTIPLY_ADD", along, 0.3, 0.7)
    half = tree.math("MULTIPLY", tree.math("MULTIPLY", blunt, taper), width)
    sideways = tree.math("MULTIPLY", tree.math("MULTIPLY", half, across), 0.5)
    flat = tree.math("SUBTRACT", 1.0, tree.math("POWER", across, 2.0))
    height = tree.math("MULTIPLY", tree.math("MULTIPLY", half, flat), BULGE)
    distance = tree.math("MULTIPLY", along, tree.inputs["Length"])
    forward = tree.math("MULTIPLY", distance, tree.math("COSINE", lift))
    upward = tree.math("MULTIPLY_ADD", distance, tree.math("SINE", lift), height)
    return [forward, sideways, upward]


def _turned(tree: Tree, position: list[Value]) -> Value:
    x, y, z = position
    cosine, sine = (tree.math(name, tree.inputs["Turn"]) for name in ("COSINE", "SINE"))
    return tree.combined(
        tree.math("SUBTRACT", tree.math("MULTIPLY", x, cosine), tree.math("MULTIPLY", y, sine)),
        tree.math("MULTIPLY_ADD", x, sine, tree.math("MULTIPLY", y, cosine)),
        z,
    )


SCALES = Kind(ids.SCALES_GROUP, 2, _build)
