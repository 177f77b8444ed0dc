# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work on Blender's own data, which no other thread may touch."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from contextlib import suppress
from typing import Any

from ..errors import CancelledError, RefusalError
from .job import Job, Progress

#: The work yields the part that is done, from 0 to 1, and returns its result. Where it is cancelled
#: it ends with GeneratorExit where it has yielded, and cleans up.
Pieces = Generator[float, None, Any]

POLL = 0.02  # seconds between two looks at work that is done aside


class Aside(float):
    """The part that is done where work goes on aside: the next piece only looks whether it is done,
    and uses none of Blender's data.
    """


def aside(work: Callable[[Progress], Any]) -> Pieces:
    """Runs work on plain arrays in a thread of its own, and returns its result. Where it is
    cancelled it ends when it next reports its progress; nobody waits for that.
    """
    job = Job(work)
    job.start()
    try:
        while not job.wait(POLL):
            yield Aside(job.part)
    finally:
        job.cancel()
    yield job.part  # so that what has changed meanwhile is found before the result is used
    return job.result()


def at_once(pieces: Pieces) -> Any:
    """Runs pieces to their end where nobody waits for them, and returns the result."""
    while True:
        try:
            next(pieces)
        except StopIteration as ended:
            return ended.value


class PiecewiseJob(Job):
    """Runs work in the calling thread, piece by piece: Blender stays usable between the pieces, and
    may evaluate its data anew.
    """

    def __init__(self, pieces: Pieces) -> None:
        super().__init__(lambda _progress: None)
        self._pieces = pieces

    def run(self, show: Progress) -> Any:
        while not self.is_done:
            self._step()
            show(self.part)
        return self.result()

    def start(self) -> None:
        """Does nothing: the work goes on in `advance` and `wait`."""

    def advance(self, seconds: float, check: Callable[[], None]) -> bool:
        deadline = time.monotonic() + seconds
        is_checked = False
        while not self.is_done and time.monotonic() < deadline:
            if not is_checked and not isinstance(self.part, Aside):
                # nobody else changes anything until this method returns
                self._checked(check)
                is_checked = True
            if self._error is None:
                self._step()
            else:
                self._end()
        return self.is_done

    def wait(self, seconds: float) -> bool:
        """Works so long. Nothing can have changed before, because the work begins here."""
        return self.advance(seconds, lambda: None)

    def cancel(self) -> None:
        if not self.is_done:
            self._error = CancelledError("Cancelled: nothing was made")
            self._end()

    def _end(self) -> None:
        """Has the work clean up."""
        self._done.set()
        with suppress(RefusalError, ReferenceError):  # what it would clean up has been removed
            self._pieces.close()

    def _step(self) -> None:
        try:
            self.part = next(self._pieces)
        except StopIteration as ended:
            self._made, self.part = ended.value, 1.0
            self._done.set()
        except ReferenceError:
            self._error = RefusalError("Something that is needed was removed meanwhile")
            self._done.set()
        except BaseException as error:
            self._error = error
            self._done.set()
