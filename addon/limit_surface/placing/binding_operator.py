# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators share that bind things to a surface."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy

from .. import native
from ..tasks.properties import SummaryProperty
from .mending import mended


class BindingOperator(SummaryProperty):
    """Mixin for operators that write tables of a surface. Refusals are reported as errors. A
    subclass provides `bind`.
    """

    if TYPE_CHECKING:  # of bpy.types.Operator, the other base of its subclasses
        report: Callable[[set[str], str], None]

    def bind(self, context: bpy.types.Context) -> set[str]:
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        try:
            with mended():
                return self.bind(context)
        except native.refusals as error:
            self.report({"ERROR"}, str(error))
        except MemoryError:
            self.report({"ERROR"}, "There is not enough memory for the tables")
        return {"CANCELLED"}
