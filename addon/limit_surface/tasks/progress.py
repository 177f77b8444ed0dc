# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of work, as users see it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy

from .status_bar import StatusText

TICK = 0.1  # seconds


@contextmanager
def progress_bar(window_manager: bpy.types.WindowManager) -> Iterator[Callable[[float], None]]:
    """Shows progress at the mouse while Blender is blocked. Yields a function to call with the part
    that is done, from 0 to 1.
    """
    window_manager.progress_begin(0, 100)
    try:
        yield lambda part: window_manager.progress_update(int(100 * part))
    finally:
        window_manager.progress_end()


class Waiting:
    """Shows progress at the mouse and in the status bar while Blender stays usable. Timer events
    tell the operator when to check the job.
    """

    def __init__(self, context: bpy.types.Context, text: str) -> None:
        self._text = text
        self._status = StatusText(context)
        self._window_manager = context.window_manager
        self._timer = self._window_manager.event_timer_add(TICK, window=context.window)
        self._window_manager.progress_begin(0, 100)
        self.show(0.0)

    def show(self, part: float) -> None:
        self._window_manager.progress_update(int(100 * part))
        self._status.show(f"{self._text}: {part:.0%}    ESC: Cancel")

    def end(self) -> None:
        self._window_manager.event_timer_remove(self._timer)
        self._window_manager.progress_end()
        self._status.clear()
