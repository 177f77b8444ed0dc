# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that operators share, whatever they make."""

import bpy
import numpy as np
from bpy.props import BoolProperty, StringProperty

from ..errors import RefusalError
from . import wrapped_text

#: The properties that only limit something: where they are infinite there is no limit
_LIMITS = {
    "depth", "distance", "full_color", "max_distance", "pixels", "row_distance", "tolerance",
}  # fmt: skip
_LARGEST = float(np.finfo(np.float32).max)


class SummaryProperty:
    """Mixin with the summary that redo panels and dialogs show."""

    summary: StringProperty(
        name="Result",
        description="Summary of what the operator did",
        options={"HIDDEN", "SKIP_SAVE"},
    )


class LargeCountProperty:
    """Mixin with the consent to very large counts (tasks/request_size.py)."""

    allow_large: BoolProperty(
        name="Allow Large Counts",
        description="Allow the operator to make millions of elements without confirmation. "
        "Scripts have to set it, because they cannot confirm",
        default=False,
        options={"SKIP_SAVE"},
    )


def check_numbers(properties: bpy.types.OperatorProperties) -> None:
    """Raises RefusalError for the first property that is not a number, or that is infinite and no
    limit: whatever its limits, Blender accepts NaN from scripts, and takes infinity for the largest
    number.
    """
    for each in properties.bl_rna.properties:
        if each.type != "FLOAT":
            continue
        values = np.asarray(getattr(properties, each.identifier), np.float64)
        if np.isnan(values).any():
            raise RefusalError(f"{each.name} is not a number")
        if each.identifier not in _LIMITS and (np.abs(values) >= _LARGEST).any():
            raise RefusalError(f"{each.name} is infinite")


def draw_summary(layout: bpy.types.UILayout, summary: str) -> None:
    """Draws what an operator has done, in redo panels and dialogs. Each line of the summary begins
    a new line, and takes as many as it needs.
    """
    for line in summary.splitlines():
        wrapped_text.draw(layout, line, "INFO")
