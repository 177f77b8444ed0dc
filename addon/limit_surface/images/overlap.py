# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps that overlap themselves: several places of the surface share texels.

Subdivision folds many a good map a little, at concave corners of its islands. That is told of;
a map whose islands lie upon each other is refused, unless it is asked for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..errors import RefusalError

if TYPE_CHECKING:
    import limitsurf

MOST_FOLDED = 1 / 500  # of the texels that a tile's map covers


def check(texels: limitsurf.Texels, where: str) -> None:
    """RefusalError where the map does more than fold."""
    count, covered = overlapping(texels), int(np.count_nonzero(texels.inside))
    if count > MOST_FOLDED * covered:
        raise RefusalError(
            f"The UV map overlaps itself at {count:,} of {covered:,} texels{where}: set Overlap to "
            "Allow to take the first face there"
        )


def overlapping(texels: limitsurf.Texels) -> int:
    return int(np.count_nonzero(texels.overlap))


def told(count: int) -> str:
    """A warning."""
    return (
        f"the UV map overlaps itself at {count:,} texels: they belong to the face with the lowest "
        "number there"
    )
