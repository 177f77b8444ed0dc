# SPDX-License-Identifier: GPL-3.0-or-later
"""Work on plain arrays with progress that can be cancelled, in the calling thread or in a thread of
its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from threading import Event, Thread
from typing import Any

from ..errors import CancelledError

Progress = Callable[[float], None]


def part_of(progress: Progress, begin: float, end: float) -> Progress:
    """Returns the function with which a piece of the work reports its own progress, from 0 to 1."""
    return lambda part: progress(begin + (end - begin) * part)


def slices(count: int, size: int, progress: Progress) -> Iterator[slice]:
    """Yields `count` rows in slices of at most `size`, and reports the progress after each
    slice.
    """
    for begin in range(0, count, size):
        rows = slice(begin, min(begin + size, count))
        yield rows
        progress(rows.stop / count)


class Job:
    """Runs `work`, which gets a function to call with the part that is done, from 0 to 1. In a
    cancelled job that function raises CancelledError, which ends the work. Work that runs in a
    thread must not touch Blender's data.
    """

    def __init__(self, work: Callable[[Progress], Any]) -> None:
        self._work = work
        self._cancelled = Event()
        self._done = Event()
        self._made: Any = None
        self._error: BaseException | None = None
        self.part = 0.0

    def run(self, show: Progress) -> Any:
        """Runs the work in the calling thread."""
        self._run(show)
        return self.result()

    def start(self) -> None:
        """Runs the work in a thread of its own. The program waits for it at its exit, so a job that
        is not needed any more should be cancelled.
        """
        Thread(target=self._run, args=(lambda _part: None,)).start()

    def wait(self, seconds: float) -> bool:
        """Returns whether the work is done by then."""
        return self._done.wait(seconds)

    def advance(self, _seconds: float, check: Callable[[], None]) -> bool:
        """Gives work that has no thread of its own so much time of the calling one, and returns
        whether the work is done. Calls `check` where Blender's data may have changed before they
        are used again; what it raises ends the work.
        """
        if not self.is_done:
            return False
        if self._error is None:
            self._checked(check)
        return True

    @property
    def is_done(self) -> bool:
        return self._done.is_set()

    def cancel(self) -> None:
        """Asks the work to stop. It ends when it next reports its progress, and has no result."""
        self._cancelled.set()

    def result(self) -> Any:
        """Returns the result, or raises the error that ended the work."""
        if self._error is not None:
            raise self._error
        return self._made

    def _checked(self, check: Callable[[], None]) -> None:
        try:
            check()
        except Exception as error:
            self._error = error

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
