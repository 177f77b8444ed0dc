# SPDX-License-Identifier: GPL-3.0-or-later
"""Guides and children, and guides of two sides that a parting keeps apart."""

import bpy
import numpy as np
import scenes


def add_guides(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    settings = {"distribution": "UNIFORM", "count": 30, "points": 8, "length": 0.3}
    return scenes.add_hair(ob, **settings | properties)


def add_children(guides: bpy.types.Object, **properties: object) -> bpy.types.Object:
    scenes.activate(guides)
    settings = {"distribution": "UNIFORM", "count": 300}
    assert bpy.ops.object.limit_children_add(**settings | properties) == {"FINISHED"}
    return bpy.context.active_object


def lengths(strands: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.diff(strands, axis=1), axis=2).sum(axis=1)


def two_sided(ob: bpy.types.Object) -> bpy.types.Object:
    """Adds guides that lean to the left where x < 2, and to the right elsewhere."""
    guides = add_guides(ob, count=60)
    strands = scenes.strands(guides)
    left = strands[:, 0, 0] < 2
    lean = np.where(left, -1, 1)[:, None] * np.linspace(0, 1, 8)
    strands[:, :, 0] = strands[:, :1, 0] + lean
    guides.data.points.foreach_set("position", strands.ravel())
    guides.data.update_tag()
    return guides


def check_parted(made: bpy.types.Object) -> None:
    strands = scenes.strands(made)
    leans = strands[:, -1, 0] - strands[:, 0, 0]
    np.testing.assert_array_equal(np.sign(leans), np.where(strands[:, 0, 0] < 2, -1, 1))
    bent = np.abs(leans) / lengths(strands)
    assert bent.min() > 0.9


def sheet() -> bpy.types.Object:
    ob = scenes.flat_grid(4)
    scenes.add_subsurf(ob)
    return ob
