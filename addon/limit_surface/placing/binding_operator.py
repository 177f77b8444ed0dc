# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators share that bind things to a surface."""

from __future__ import annotations

import bpy

from ..tasks.piecewise_job import Pieces, PiecewiseJob
from ..tasks.watched_operator import WatchedOperator
from .mending import mended


class BindingOperator(WatchedOperator):
    """Mixin for operators that write tables of a surface. A subclass provides `bind`.

    `tasks/watched_operator.py` says where this stands among the steps of an operator. The last
    piece of `bind` is the one that changes something. It is not divided: Blender pushes an undo
    step only when an operator has finished, so that nothing could take back a part of the change.
    """

    doing = "Binding"  # what the status bar shows
    too_large = "There is not enough memory for the tables"
    cancelled = "Cancelled: nothing has changed"

    def bind(self, context: bpy.types.Context) -> Pieces:
        """Returns what the operator returns."""
        raise NotImplementedError

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        return self.watch(context, PiecewiseJob(self._pieces(context)), self.doing)

    def finish(self, _context: bpy.types.Context, made: set[str]) -> set[str]:
        return made

    def _pieces(self, context: bpy.types.Context) -> Pieces:
        with mended():
            return (yield from self.bind(context))
