# SPDX-License-Identifier: GPL-3.0-or-later
"""The distribution of children: the locations that reach a guide, with their guides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import RefusalError
from ..placing.distribution import Expected, Scattered
from ..placing.region import Region
from ..placing.roots import Locations
from ..placing.scatter_operator import Distributes
from ..tasks.job import Progress, part_of
from .guides import Guides

_SCATTERED = 0.4  # the part of the progress at which the locations are found


@dataclass(frozen=True, kw_only=True)
class Followed(Scattered):
    """Locations with their guides."""

    guides: Guides
    guide: np.ndarray  # (n, k) rows of the guides; -1 where one lacks
    weight: np.ndarray  # (n, k)
    unreached: int  # the number of locations that were left out, because no guide can be reached


@dataclass(frozen=True)
class Spread:
    """A Distribution whose locations know their guides."""

    distribution: Distributes
    guides: Guides
    count: int  # guides of each child

    @property
    def amount(self) -> str:
        return self.distribution.amount

    def expected(self, region: Region) -> Expected:
        return self.distribution.expected(region)

    def scatter(self, region: Region, progress: Progress) -> Followed:
        found = self.distribution.scatter(region, part_of(progress, 0, _SCATTERED))
        at, guides = found.locations, self.guides.at
        # distances are measured in the world, and may lead over faces that are not covered
        surface = region.cage.surface(in_world=True)
        try:
            near = surface.guide_weights(
                guides.face,
                guides.uv,
                at.face,
                at.uv,
                self.count,
                **region.sources["parting"]._asdict(),
                progress=part_of(progress, _SCATTERED, 1),
            )
        except ValueError as error:  # the partings have been read as finite curves
            raise RefusalError(
                f"The partings are too long for {region.cage.name}, whose faces are millions of "
                "times smaller"
            ) from error
        reached = near.guide[:, 0] >= 0
        if len(at) and not reached.any():
            raise RefusalError(
                f"No guide of {self.guides.key.name} can be reached along the surface from the "
                "faces that are covered"
            )
        return Followed(
            locations=Locations(at.face[reached], at.uv[reached]),
            distance=found.distance,
            curves=found.curves,
            guides=self.guides,
            guide=near.guide[reached],
            weight=near.weight[reached],
            unreached=int((~reached).sum()),
        )
