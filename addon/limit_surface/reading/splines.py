# SPDX-License-Identifier: GPL-3.0-or-later
"""The control points of Curve and Surface objects as arrays, spline by spline."""

import bpy
import numpy as np


def points(spline: bpy.types.Spline) -> bpy.types.bpy_prop_collection:
    return spline.bezier_points if spline.type == "BEZIER" else spline.points


def values(of: bpy.types.bpy_prop_collection, name: str) -> np.ndarray:
    """Returns the coordinates (n, 3) of points or handles, or (n, 4) with weights."""
    found = np.empty((len(of), len(getattr(of[0], name))), np.float32)
    of.foreach_get(name, found.ravel())
    return found


def positions(data: bpy.types.Curve) -> np.ndarray:
    """Returns all control points (n, 3), in the order in which nodes number them."""
    parts = [values(points(spline), "co")[:, :3] for spline in data.splines]
    return np.concatenate([np.empty((0, 3), np.float32), *parts])
