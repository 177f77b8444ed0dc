# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts that fit panels and dialogs, which cut lines off at their edge."""

import textwrap

import bpy

SIDEBAR = 34  # characters of a usual text that fit a line of a sidebar or redo panel


def draw(layout: bpy.types.UILayout, text: str, icon: str, width: int = SIDEBAR) -> None:
    """Draws a text in as many lines as it needs. The first one has the icon."""
    column = layout.column(align=True)
    for i, line in enumerate(textwrap.wrap(text, width)):
        column.label(text=line, icon="BLANK1" if i else icon)


def draw_alert(layout: bpy.types.UILayout, text: str) -> None:
    """Draws a text that says what is wrong, in red."""
    column = layout.column()
    column.alert = True
    draw(column, text, "ERROR")
