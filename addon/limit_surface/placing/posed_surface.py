# SPDX-License-Identifier: GPL-3.0-or-later
"""A limit surface as it is in one frame, seen from the world and from the spaces of objects."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..reading import cage, transform
from .roots import Locations, off_vertices
from .rotations import WorldSpace

if TYPE_CHECKING:
    import limitsurf

SAME = 1e-6  # as a share of the largest coordinate: Blender's single precision allows no more


class Places(NamedTuple):
    position: np.ndarray  # (n, 3)
    frame: np.ndarray  # (n, 3, 3) rotations: columns tangent, normal x tangent, outward normal


class PosedSurface:
    """Both surfaces are made when they are asked for. That in the world is another one because
    closest points are different in the space of a stretched object.
    """

    def __init__(self, found: cage.Cage) -> None:
        WorldSpace(found.matrix, found.name)  # refuses objects whose scale is 0 along an axis
        self.cage = found

    @cached_property
    def in_object(self) -> limitsurf.LimitSurface:
        return self.cage.surface()

    @cached_property
    def in_world(self) -> limitsurf.LimitSurface:
        return self.cage.surface(in_world=True)

    def places(self, face: np.ndarray, uv: np.ndarray, space: np.ndarray) -> Places:
        """Returns positions and frames in the space that the matrix `space` maps to the world."""
        found = self.in_object.placed_frames(face, uv)
        return seen_from(space, Places(found.position, found.frame), self.cage.matrix)


def at_closest(posed: PosedSurface, hits: limitsurf.Hits) -> Locations:
    """Returns locations for things that are bound at these closest places in the world."""
    is_on_surface = hits.distance <= SAME * np.abs(posed.in_world.positions).max()
    uv = off_vertices(hits.uv, is_on_surface)
    return Locations(hits.face.astype(np.int32), uv.astype(np.float32))


def seen_from(space: np.ndarray, places: Places, matrix: np.ndarray) -> Places:
    """Returns places in the space that the matrix `space` maps to the world. They are given in the
    space of `matrix`.
    """
    if np.array_equal(space, matrix):
        return places
    relation = transform.relation(space, matrix, "An object")
    frame = WorldSpace(relation).frames(places.frame)
    frame[:, :, 1] = np.cross(frame[:, :, 2], frame[:, :, 0])
    return Places(transformed(relation, places.position), frame)


def positions_seen_from(space: np.ndarray, points: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Returns the positions that `seen_from` gives."""
    if np.array_equal(space, matrix):
        return points
    return transformed(transform.relation(space, matrix, "An object"), points)


def transformed(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    return points @ matrix[:3, :3].T + matrix[:3, 3]
