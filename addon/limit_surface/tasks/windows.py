# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's windows, which may be closed while something runs in them."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import Any

import bpy


def within(
    context: bpy.types.Context, window: bpy.types.Window | None
) -> AbstractContextManager[Any]:
    """Makes this the context's window for a while. One that was closed is not used: Blender would
    crash.
    """
    if any(each == window for each in context.window_manager.windows):
        return context.temp_override(window=window)
    return nullcontext()
