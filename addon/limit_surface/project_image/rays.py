# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays through an image that meet the surface, and the extent of the surface between their hits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..reading.projector import Projector
from .world import WorldSurface

HALVINGS = 16  # number of times a cell's side is halved to find a border
# The surface goes on where the hit of the middle ray is closer to the middle of the chord between
# its two hits than this share of the chord.
BEND = 0.02
MOST_BREAKS = 8  # along one side of a cell
# As a share of the first gap: if hits stay farther apart than this when their rays come close, the
# surface does not go on between them.
JUMP = 2.0**-6


@dataclass(frozen=True)
class Hits:
    """The hits of rays on the surface. A ray that has missed has the face -1."""

    st: np.ndarray  # (n, 2) in the image
    face: np.ndarray
    uv: np.ndarray
    position: np.ndarray
    normal: np.ndarray  # outward
    facing: np.ndarray  # 1 where the surface's outer side is seen, -1 for its inner one

    def __len__(self) -> int:
        return len(self.face)

    @property
    def valid(self) -> np.ndarray:
        return self.face >= 0

    def take(self, rows: np.ndarray | slice) -> Hits:
        return Hits(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))

    def where(self, chosen: np.ndarray, other: Hits) -> Hits:
        """Returns these rows where chosen, and those of `other` elsewhere."""
        pairs = ((getattr(self, n), getattr(other, n)) for n in self.__dataclass_fields__)
        return Hits(*(np.where(chosen.reshape(-1, *[1] * (a.ndim - 1)), a, b) for a, b in pairs))


def joined(parts: list[Hits]) -> Hits:
    names = Hits.__dataclass_fields__
    return Hits(*(np.concatenate([getattr(p, name) for p in parts]) for name in names))


class Rays:
    def __init__(
        self, world: WorldSurface, projector: Projector, steepest: float, two_sided: bool
    ) -> None:
        """`steepest` is the largest angle between a ray and the normal, in radians."""
        self._world, self._projector = world, projector
        self._least, self._two_sided = np.cos(steepest), two_sided

    def cast(self, st: np.ndarray) -> Hits:
        near, far = (self._world.to_surface(ends) for ends in self._projector.rays(st))
        along = far - near
        length = np.linalg.norm(along, axis=1)
        found = self._world.surface.ray_cast(near, along, length.max(initial=0))
        against = -np.einsum("ij,ij->i", found.normal, along) / length
        seen = np.abs(against) if self._two_sided else against
        # A place without a normal does not count as turned away.
        dropped = (found.face < 0) | (found.distance > length) | (seen < self._least)
        face = np.where(dropped, -1, found.face)
        return Hits(
            st, face, found.uv, found.position, found.normal, np.where(against < 0, -1.0, 1.0)
        )

    def furthest(self, start: Hits, stop: Hits) -> tuple[np.ndarray, Hits]:
        """Follows the image's straight line from each hit to another place. Returns whether the
        surface goes on all the way, and the last hit up to which it does.
        """
        # Even if the surface reaches the place where rays begin to miss, it may have a jump before.
        goes_on, last = self._unbroken(start, self._border(start, stop))
        return goes_on & stop.valid, last

    def _border(self, start: Hits, stop: Hits) -> Hits:
        """Returns `stop`, or the last valid hit before it where `stop` is not valid."""
        rows = np.flatnonzero(~stop.valid)
        low, high = start.take(rows), stop.take(rows)
        for _ in range(HALVINGS):
            middle = self.cast((low.st + high.st) / 2)
            low, high = middle.where(middle.valid, low), high.where(middle.valid, middle)
        return _put(stop, rows, low)

    def _unbroken(self, start: Hits, stop: Hits) -> tuple[np.ndarray, Hits]:
        """Takes valid ends. Jumps are searched for one after the other, each before the last
        one.
        """
        last, rows = stop, np.arange(len(start))
        for _ in range(MOST_BREAKS):
            held, before = self._up_to_break(start.take(rows), last.take(rows))
            last, rows = _put(last, rows, before), rows[~held]
            if not rows.size:
                break
        else:
            last = _put(last, rows, start.take(rows))
        return (last.st == stop.st).all(axis=1), last

    def _up_to_break(self, start: Hits, stop: Hits) -> tuple[np.ndarray, Hits]:
        """Returns whether there is no jump, and the last hit before one. Rays are halved towards
        the larger gap, or towards rays that miss.
        """
        gap = _distance(start, stop)
        middle = self.cast((start.st + stop.st) / 2)
        off = np.linalg.norm(middle.position - (start.position + stop.position) / 2, axis=1)
        held = (middle.valid & (off <= BEND * gap)) | (gap == 0)
        rows = np.flatnonzero(~held)
        low, high = start.take(rows), stop.take(rows)
        for _ in range(HALVINGS):
            middle = self.cast((low.st + high.st) / 2)
            nearer = ~high.valid | (_distance(low, middle) <= _distance(middle, high))
            nearer &= middle.valid
            low, high = middle.where(nearer, low), high.where(nearer, middle)
        held[rows] = high.valid & (_distance(low, high) <= JUMP * gap[rows])
        return held, _put(stop, np.flatnonzero(~held), low.take(~held[rows]))


def _put(hits: Hits, rows: np.ndarray, values: Hits) -> Hits:
    whole = hits.take(slice(None))
    copies = {name: getattr(whole, name).copy() for name in Hits.__dataclass_fields__}
    for name, column in copies.items():
        column[rows] = getattr(values, name)
    return Hits(**copies)


def _distance(a: Hits, b: Hits) -> np.ndarray:
    return np.linalg.norm(a.position - b.position, axis=1)
