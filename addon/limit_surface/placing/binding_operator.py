# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators share that bind things to a surface."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from .. import ids
from ..tasks.piecewise_job import Pieces, PiecewiseJob
from ..tasks.watched_operator import WatchedOperator
from . import live_binding
from .followers import live_modifier_of
from .mending import mended

_PLACES = (ids.FACE, ids.UV, ids.REST_ROOT)


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


def rely_on_bound(operator: WatchedOperator, things: Sequence[bpy.types.Object]) -> None:
    """Has the operator rely on things that stand on a surface, and on what shares their data. The
    shape of what follows live is that of the frame, and does not count.
    """
    for ob in live_binding.with_sharers(things):
        operator.rely_on(ob, shape=live_modifier_of(ob) is None, named=_PLACES)
