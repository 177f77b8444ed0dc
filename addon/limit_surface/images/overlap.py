# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps that overlap themselves: several places of the surface share texels.

Subdivision folds many good maps a little, at concave corners of their islands. Operators warn of
such folds. They refuse a map whose islands lie on each other, unless the user allows it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..counting import by_count, counted
from ..errors import RefusalError

if TYPE_CHECKING:
    import limitsurf

# the share of a tile's covered texels up to which an overlap counts as a fold
MOST_FOLDED = 1 / 500


def check(texels: limitsurf.Texels, where: str) -> None:
    """Raises RefusalError where the map overlaps itself by more than folds."""
    count, covered = overlapping(texels), int(np.count_nonzero(texels.inside))
    if count > MOST_FOLDED * covered:
        raise RefusalError(
            f"The UV map overlaps itself at {count:,} of {counted(covered, 'texels')}{where}: set "
            "Overlap to Allow to use the face with the lowest number there"
        )


def overlapping(texels: limitsurf.Texels) -> int:
    return int(np.count_nonzero(texels.overlap))


def told(count: int) -> str:
    """Returns a warning about the folds."""
    show = by_count(count, "it shows", "they show")
    return (
        f"the UV map overlaps itself at {counted(count, 'texels')}: {show} the face with the "
        "lowest number there"
    )
