# SPDX-License-Identifier: GPL-3.0-or-later
"""The texts that report a bake."""

import numpy as np

from ..counting import by_count, counted
from ..images import overlap
from .map_images import Baked
from .maps import KINDS, NORMAL_TANGENT, Range


def ranges(baked: Baked) -> list[str]:
    """Returns a line for each map whose values have become colors."""
    return [f"{KINDS[name].name}: {_said(found)}" for name, found in baked.ranges.items()]


def warnings(baked: Baked, flat_faces: int) -> list[str]:
    found = []
    if flat_faces:
        have = counted(flat_faces, "faces", "has", "have")
        are = by_count(flat_faces, "is", "are")
        found.append(f"{have} no area on the UV map and {are} not in the images")
    if baked.overlapping:
        found.append(overlap.told(baked.overlapping))
    if baked.without_values:
        have = counted(baked.without_values, "values", "has", "have")
        were = by_count(baked.without_values, "was", "were")
        found.append(f"{have} no limit and {were} set to 0")
    if baked.without_polygons:
        have = counted(baked.without_polygons, "texels", "has", "have")
        found.append(f"{KINDS[NORMAL_TANGENT].name}: {have} no polygon on the UV map")
    return found


def _said(range_: Range) -> str:
    low, high = (np.atleast_1d(end) for end in range_)
    return f"0 is {_numbers(low)}, 1 is {_numbers(high)}"


def _numbers(values: np.ndarray) -> str:
    text = ", ".join(f"{value:.5g}" for value in values)
    return f"({text})" if len(values) > 1 else text
