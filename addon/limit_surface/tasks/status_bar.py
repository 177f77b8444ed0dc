# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts in the status bar that are shown until they are taken away.

Blender keeps such a text with the workspace that a window shows at that moment, and no other one
can be reached: the text would stay where somebody has changed to another workspace meanwhile. What
Blender lets be drawn instead of a text counts for all workspaces.
"""

from __future__ import annotations

import bpy

from . import windows

_shown: list[StatusText] = []


class StatusText:
    """A text in the status bar of the context's window, whatever workspace is shown there."""

    def __init__(self, context: bpy.types.Context) -> None:
        self._context, self.window = context, context.window
        self.text = ""

    def show(self, text: str) -> None:
        self.text = text
        if self not in _shown:
            _shown.append(self)
        self._draw_anew()

    def clear(self) -> None:
        if self in _shown:
            _shown.remove(self)
            self._draw_anew()

    def _draw_anew(self) -> None:
        with windows.within(self._context, self.window):
            self._context.workspace.status_text_set(_draw if _shown else None)


def _draw(header: bpy.types.Header, context: bpy.types.Context) -> None:
    """Draws the status bar of one window: as Blender does where it has none of the texts."""
    own = [each.text for each in _shown if each.window == context.window]
    if own:
        header.layout.label(text=own[-1])
    else:
        type(header)._draw_orig(header, context)
