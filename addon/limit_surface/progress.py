# SPDX-License-Identifier: GPL-3.0-or-later
"""The progress bar at the mouse."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy


@contextmanager
def progress_bar(window_manager: bpy.types.WindowManager) -> Iterator[Callable[[float], None]]:
    """Gives a function to call with the part that is done, 0 to 1."""
    window_manager.progress_begin(0, 100)
    try:
        yield lambda part: window_manager.progress_update(int(100 * part))
    finally:
        window_manager.progress_end()
