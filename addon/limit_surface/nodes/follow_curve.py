# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Limit Curve*, whose modifier moves a Curve object with the limit surface.

The data of such objects has no attributes. The attributes of their control points are therefore on
the vertices of a table, in the order of the control points.
"""

import bpy

from .. import ids
from .follow import Roots, carried, finished, new_tree, with_handles
from .groups import Kind
from .tree import Socket, Tree, Value

POINTS = "Points"  # the name of the input


def _build() -> bpy.types.NodeTree:
    tree = new_tree(
        ids.FOLLOW_CURVE_GROUP,
        "Curve",
        Socket(POINTS, "Object", "Hidden object that stores where the control points are"),
    )
    geometry = tree.inputs["Geometry"]
    table = tree.object_info(tree.inputs[POINTS])["Geometry"]
    on = carried(tree, geometry, "POINT", _roots(tree, table))
    is_same = tree.compare(
        "EQUAL",
        tree.get("GeometryNodeAttributeDomainSize", geometry, component="CURVE"),
        tree.get("GeometryNodeAttributeDomainSize", table, component="MESH"),
    )
    tree.warn(
        tree.negated(is_same),
        "The number of control points has changed: run Rebind to Limit Surface",
    )
    on = on._replace(fits=tree.both(on.fits, is_same))
    return finished(tree, on, with_handles(tree, on))


def _roots(tree: Tree, table: Value) -> Roots:
    def of_point(name: str, kind: str) -> Value:
        return tree.sample(table, tree.attribute(name, kind), tree.index(), kind)

    return Roots(
        of_point(ids.TILE, "INT"),
        of_point(ids.TILE_UV, "FLOAT_VECTOR"),
        of_point(ids.REST_ROOT, "FLOAT_VECTOR"),
        of_point(ids.REST_ROTATION, "QUATERNION"),
    )


FOLLOW_CURVE = Kind(ids.FOLLOW_CURVE_GROUP, 2, _build)
