# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that operators share, whatever they make."""

import bpy
from bpy.props import BoolProperty, StringProperty


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


def draw_summary(layout: bpy.types.UILayout, summary: str) -> None:
    """Draws what an operator has done, line by line, in redo panels and dialogs."""
    for line in summary.splitlines():
        layout.label(text=line, icon="INFO")
