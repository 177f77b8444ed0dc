# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points from elsewhere: they are bound at their closest points on a surface, and keep
their distance from it. Nothing moves.
"""

from __future__ import annotations

import math

import bpy
import numpy as np

from .. import ids
from .posed_surface import PosedSurface
from .relocation import Elements, Relocation
from .rotations import quaternions


def bound_at_closest(
    elements: Elements,
    posed: PosedSurface,
    rows: np.ndarray,
    max_distance: float = math.inf,
) -> Relocation:
    """Binds some elements where they are. Those beyond the distance (world units) are lost."""
    hits = posed.in_world.closest(elements.roots()[rows], max_distance)
    found = hits.face >= 0
    rows, lost = rows[found], rows[~found]
    relocation = Relocation(elements, lost=lost, distances=np.zeros(len(rows)))
    put_places(relocation, posed, rows, hits.face[found], hits.uv[found])
    return relocation


def put_places(
    relocation: Relocation,
    posed: PosedSurface,
    rows: np.ndarray,
    face: np.ndarray,
    uv: np.ndarray,
) -> np.ndarray:
    """Stores locations and the roots at rest there, and returns the frames (n, 3, 3) there."""
    rounded = uv.astype(np.float32)
    places = posed.places(face, rounded.astype(np.float64), relocation.elements.matrix)
    relocation.put(ids.FACE, rows, face)
    relocation.put(ids.UV, rows, rounded)
    relocation.put(ids.REST_ROOT, rows, places.position)
    relocation.put(ids.REST_ROTATION, rows, quaternions(places.frame))
    return places.frame


def newcomers(ob: bpy.types.Object, posed: PosedSurface) -> Relocation | None:
    """Returns the places of those strands or points that have none; None if all have one."""
    elements = Elements(ob)
    rows = np.flatnonzero(~elements.has_place)
    return bound_at_closest(elements, posed, rows) if len(rows) else None
