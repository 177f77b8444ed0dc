# SPDX-License-Identifier: GPL-3.0-or-later
"""What runs until it is done: modal operators, and the jobs that they look after.

Where the class of an operator is taken away while the operator runs, as when somebody disables the
extension, Blender forgets the operator and calls none of its methods. So all that runs is ended
before: jobs are cancelled, what is dragged goes back, and what is shown on the screen is removed.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable

import bpy

from . import windows

_all: list[Running] = []


class Running:
    """One thing that runs in a window. `end` ends it at once, as if the user had cancelled it."""

    def __init__(
        self, context: bpy.types.Context, end: Callable[[bpy.types.Context], None]
    ) -> None:
        self._context, self._window, self._end = context, context.window, end
        _all.append(self)

    def over(self) -> None:
        """Is to be called when it has ended, in whatever way. It may be called again."""
        if self in _all:
            _all.remove(self)

    def end(self) -> None:
        """Ends it in its own window: the user may be in another one, such as the Preferences."""
        self.over()
        with windows.within(self._context, self._window):
            self._end(self._context)


def end_all() -> None:
    """Ends all that runs. What cannot be ended does not keep the rest."""
    for each in reversed(_all.copy()):
        try:
            each.end()
        except Exception:
            traceback.print_exc()
