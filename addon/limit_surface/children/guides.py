# SPDX-License-Identifier: GPL-3.0-or-later
"""The guides that children follow, read from hair that stands on the surface."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import native
from ..errors import RefusalError
from ..placing import followers, following, shown_strands
from ..placing.places import Places
from ..placing.roots import Locations
from ..reading import cage
from ..tasks.object_keys import ObjectKey


@dataclass(frozen=True)
class Guides:
    key: ObjectKey
    count: int  # of the strands of the object
    strand: np.ndarray  # (g,) the strands that have a place on the surface
    at: Locations  # their places
    # (g, points, 3) as they are in this frame: in the world, but for the place of its origin
    points: np.ndarray


def read(
    ob: bpy.types.Object,
    surface: bpy.types.Object,
    found: cage.Cage,
    points: int,
    depsgraph: bpy.types.Depsgraph,
) -> Guides:
    """Reads the guides with so many points on each, at equal distances. Raises RefusalError for
    hair that cannot guide.
    """
    followers.check_placed(ob)
    following.check_holds(ob, surface, following.signature(found))
    places = Places.read(ob.data)
    if not len(places.rows):
        raise RefusalError(f"{ob.name} has no strand with a place on {surface.name}")
    places.check(found.ptex_face_count, surface.name)
    positions, offsets = shown_strands.read(ob, found.matrix, depsgraph)
    in_world = positions @ found.matrix[:3, :3].T
    shapes = native.limitsurf.resample_strands(in_world, offsets, points)
    at = Locations(places.face.astype(np.int32), places.uv.astype(np.float32))
    return Guides(ObjectKey.of(ob), places.count, places.rows, at, shapes[places.rows])
