# SPDX-License-Identifier: GPL-3.0-or-later
"""Work on plain arrays that can be watched and cancelled, here or in a thread of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from threading import Event, Thread
from typing import Any

from ..errors import CancelledError

Progress = Callable[[float], None]


def part_of(progress: Progress, begin: float, end: float) -> Progress:
    """For a piece of the work: what to call with the part of the piece that is done."""
    return lambda part: progress(begin + (end - begin) * part)


def slices(count: int, size: int, progress: Progress) -> Iterator[slice]:
    """Gives `count` rows piece by piece, `size` of them at most, and tells the progress after each
    piece."""
    for begin in range(0, count, size):
        rows = slice(begin, min(begin + size, count))
        yield rows
        progress(rows.stop / count)


class Job:
    """`work` gets a function to call with the part that is done, 0 to 1. That function is where a
    cancelled job ends: it raises CancelledError. Work that is started must leave Blender's data
    alone."""

    def __init__(self, work: Callable[[Progress], Any]) -> None:
        self._work = work
        self._cancelled = Event()
        self._done = Event()
        self._made: Any = None
        self._error: BaseException | None = None
        self.part = 0.0

    def run(self, show: Progress) -> Any:
        """Here and now."""
        self._run(show)
        return self.result()

    def start(self) -> None:
        """In a thread of its own. A program that ends waits for it: cancel what is not wanted."""
        Thread(target=self._run, args=(lambda _part: None,)).start()

    def wait(self, seconds: float) -> bool:
        """Whether it is done by then."""
        return self._done.wait(seconds)

    @property
    def is_done(self) -> bool:
        return self._done.is_set()

    def cancel(self) -> None:
        """It ends when it next tells its progress, and has no result."""
        self._cancelled.set()

    def result(self) -> Any:
        """What was made, or the error that ended the work."""
        if self._error is not None:
            raise self._error
        return self._made

    def _run(self, show: Progress) -> None:
        def progress(part: float) -> None:
            if self._cancelled.is_set():
                raise CancelledError("Cancelled: nothing was made")
            self.part = part
            show(part)

        try:
            self._made = self._work(progress)
            progress(1.0)
        except BaseException as error:
            self._error = error
        finally:
            self._done.set()
