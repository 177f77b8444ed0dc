# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that nobody expects while things that follow live are posed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bpy

from . import live_kept


class Defects:
    """An error on one surface does not keep what follows other surfaces from being posed. It is
    raised after that, so that it is not hidden.
    """

    def __init__(self) -> None:
        self._first: Exception | None = None

    @contextmanager
    def held_back(
        self, surface: bpy.types.Object, things: Sequence[bpy.types.Object]
    ) -> Iterator[None]:
        """Holds an error back until `raise_first`. The things name it as the reason why they stay
        where they are, and the surface is read as a whole the next time.
        """
        try:
            yield
        except Exception as error:
            live_kept.drop(surface)
            live_kept.refuse(things, f"{type(error).__name__}: {error}")
            self._first = self._first or error

    def raise_first(self) -> None:
        if self._first is not None:
            raise self._first
