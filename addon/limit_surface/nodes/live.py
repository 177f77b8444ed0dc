# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Limit Live*, whose modifier marks things that the extension itself moves.

The modifier changes nothing. It names the surface, and it has render engines look at the points of
each subframe: they take geometry without modifiers for rigid, and would not blur its motion.
"""

import bpy

from .. import ids
from .follow import SURFACE
from .groups import Kind
from .tree import Socket, Tree


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.FOLLOW_LIVE_GROUP,
        [
            Socket("Geometry", "Geometry", "Hair or points, which the extension moves"),
            Socket(SURFACE, "Object", "Mesh to follow"),
        ],
        [Socket("Geometry", "Geometry", "The same, unchanged")],
        is_modifier=True,
    )
    return tree.finish(Geometry=tree.inputs["Geometry"])


FOLLOW_LIVE = Kind(ids.FOLLOW_LIVE_GROUP, 1, _build)
