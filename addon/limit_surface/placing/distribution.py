# SPDX-License-Identifier: GPL-3.0-or-later
"""Locations over a region by one of the distributions, and the expected number of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import native
from ..errors import RefusalError
from ..tasks.job import Progress
from .border import Amount, BorderDirections, BorderLayout, Turn, where_rows_end
from .region import Region
from .roots import Locations

if TYPE_CHECKING:
    import limitsurf

#: The number of locations on the area of a square whose side is the distance between them, when no
#: further location fits anywhere
PACKING = 0.7

NO_AREA = "The surface has no area"
_NOWHERE = "The density is 0 everywhere: check its source and its range"
_TOO_LOW = "The density is so low that no place was found: check its source and its range"


@dataclass(frozen=True)
class Expected:
    count: int
    is_exact: bool
    candidates: int = 0  # locations that are made first, of which a density keeps some


@dataclass(frozen=True)
class Scattered:
    locations: Locations
    distance: float | None = None  # the distance in the world that they keep from each other
    directions: BorderDirections | None = None  # for things along borders
    curves: int = 0  # the number of borders
    note: str = ""  # a remark for the report


@dataclass(frozen=True)
class Distribution:
    kind: str  # JITTERED, UNIFORM, BLUE_NOISE or BORDER
    amount: str  # COUNT, DENSITY or DISTANCE
    per_side: int
    count: int
    density: float  # locations on each square unit in the world
    distance: float  # in world units
    seed: int
    border: BorderLayout  # for BORDER, as is `turn`
    turn: Turn

    def expected(self, region: Region) -> Expected:
        if self.kind == "JITTERED":
            cells = region.ptex_face_count * self.per_side**2
            if region.density is None:
                return Expected(cells, True)
            return Expected(round(cells * region.sums.weight), False, cells)
        if self.kind == "BORDER":
            return self._expected_along(region)
        if self.amount == "COUNT":
            return Expected(self.count, True)
        if self.amount == "DENSITY":
            return Expected(round(self.density * region.sums.weighted_area), True)
        self._check_distance()
        if not region.sums.largest:
            raise RefusalError(why_nothing(region))
        fit = PACKING * region.sums.weighted_area / region.sums.largest / self.distance**2
        return Expected(max(round(fit), 1), False)

    def scatter(self, region: Region, progress: Progress) -> Scattered:
        """Returns locations in single precision, the precision of files, so that what is evaluated
        there lies exactly where its stored location says.
        """
        if self.kind == "JITTERED":
            return Scattered(self._jittered(region))
        if self.kind == "BORDER":
            return self._along_border(region, progress)
        count = None if self.amount == "DISTANCE" else self.expected(region).count
        if count == 0:
            if not region.area > 0:
                raise RefusalError(NO_AREA)
            raise RefusalError(why_nothing(region))
        self._check_distance()
        common: dict[str, Any] = {
            "seed": self.seed,
            "density": region.density,
            "density_limits": region.density.limits if region.density else None,
            "progress": progress,
        }
        try:
            with region.in_world():
                if self.kind == "UNIFORM":
                    assert count is not None
                    found = region.surface.scatter_uniform(count, **common)
                    return Scattered(_rounded(found))
                radius = self.distance if count is None else None
                apart = region.surface.scatter_blue_noise(count=count, radius=radius, **common)
                return Scattered(_rounded(apart), float(apart.radius))
        except ValueError as error:  # there is no place for them, or no space for so many
            reason = _NOWHERE if region.is_empty else native.sentence(error)
            raise RefusalError(reason) from error

    def _check_distance(self) -> None:
        if self.kind == "UNIFORM" and self.amount == "DISTANCE":
            raise RefusalError(
                "Uniform keeps no distance: choose Blue Noise, or give a count or a density"
            )

    def _jittered(self, region: Region) -> Locations:
        """Returns jittered locations. With a density, each is kept with the probability that the
        density gives.
        """
        at = _rounded(region.surface.scatter_jittered(self.per_side, self.seed))
        stays = self._staying(region, at)
        return Locations(at.face[stays], at.uv[stays])

    def _staying(self, region: Region, at: Locations) -> np.ndarray:
        """Returns which locations are kept, each with the probability that the density gives."""
        if region.density is None:
            return np.ones(len(at), bool)
        density = region.density(at.face, at.uv.astype(np.float64))
        return np.random.default_rng(self.seed).random(len(at)) < density

    def _expected_along(self, region: Region) -> Expected:
        if self.amount == "DENSITY":
            raise RefusalError("A border has no area: give a count or a distance")
        sums = region.border_sums
        if self.amount == "COUNT":
            candidates = self.count * self.border.rows
            is_exact = region.density is None and self.border.rows == 1
            return Expected(round(candidates * sums.weight), is_exact, candidates)
        candidates = round(sums.length / self.distance * self.border.rows)
        return Expected(max(round(candidates * sums.weight), 1), False, candidates)

    def _along_border(self, region: Region, progress: Progress) -> Scattered:
        by_count = self.amount == "COUNT"
        amount = Amount(count=self.count) if by_count else Amount(spacing=self.distance)
        try:
            with region.in_world():
                curves = region.edge_curves()
                found = self.border.scatter(region.surface, curves, amount, self.seed, progress)
        except ValueError as error:
            raise RefusalError(native.sentence(error)) from error
        at = _rounded(found)
        stays = self._staying(region, at)
        directions = BorderDirections(found.outward, found.tangent, self.turn)
        return Scattered(
            Locations(at.face[stays], at.uv[stays]),
            directions=directions.at(stays),
            curves=len(curves),
            note=where_rows_end(found.ended, int(np.count_nonzero(found.row == 0))),
        )


def why_nothing(region: Region) -> str:
    """Returns why a density leaves no location."""
    return _NOWHERE if region.is_empty else _TOO_LOW


def _rounded(found: limitsurf.Locations) -> Locations:
    return Locations(np.asarray(found.face, np.int32), np.asarray(found.uv, np.float32))
