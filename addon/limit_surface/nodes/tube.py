# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Limit Tube*: thickness for curves that follow the surface. A bevel of the Curve object
itself would hide its control points from the nodes before.
"""

import bpy

from .. import ids
from .groups import Kind, add_modifier
from .tree import Socket, Tree

RADIUS, SIDES = "Radius", "Sides"


def add_tube(ob: bpy.types.Object, radius: float, sides: int) -> None:
    add_modifier(ob, TUBE, Radius=radius, Sides=sides)


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.TUBE_GROUP,
        [
            Socket("Geometry", "Geometry", "Curves"),
            Socket(RADIUS, "Float", "Radius where the radius of the curve is 1"),
            Socket(SIDES, "Int", "Number of sides of the tube"),
        ],
        [Socket("Geometry", "Geometry", "Tubes around the curves")],
        is_modifier=True,
    )
    circle = tree.node("GeometryNodeCurvePrimitiveCircle", mode="RADIUS")
    tree.set(circle.inputs["Resolution"], tree.inputs[SIDES])
    tree.set(circle.inputs["Radius"], tree.inputs[RADIUS])
    solid = tree.node("GeometryNodeCurveToMesh", tree.inputs["Geometry"], circle.outputs["Curve"])
    solid.inputs["Fill Caps"].default_value = True
    if "Scale" in solid.inputs:  # Blender 5.0 and later do not read the radius by themselves
        tree.set(solid.inputs["Scale"], tree.attribute("radius", "FLOAT"))
    smooth = tree.get("GeometryNodeSetShadeSmooth", solid.outputs["Mesh"])
    return tree.finish(Geometry=smooth)


TUBE = Kind(ids.TUBE_GROUP, 1, _build)
