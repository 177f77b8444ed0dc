# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work on Blender's own data, which no other thread may touch."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from typing import Any

from ..errors import CancelledError, RefusalError
from .job import Job, Progress

#: The work yields the part that is done, from 0 to 1, and returns its result. Where it is cancelled
#: it ends with GeneratorExit where it has yielded, and cleans up.
Pieces = Generator[float, None, Any]

POLL = 0.02  # seconds between two looks at work that is done aside


def aside(work: Callable[[Progress], Any]) -> Pieces:
    """Runs work on plain arrays in a thread of its own, and returns its result. Where it is
    cancelled it ends when it next reports its progress; nobody waits for that.
    """
    job = Job(work)
    job.start()
    try:
        while not job.wait(POLL):
            yield job.part
    finally:
        job.cancel()
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

    def advance(self, seconds: float) -> None:
        deadline = time.monotonic() + seconds
        while not self.is_done and time.monotonic() < deadline:
            self._step()

    def wait(self, seconds: float) -> bool:
        self.advance(seconds)
        return self.is_done

    def cancel(self) -> None:
        if not self.is_done:
            self._error = CancelledError("Cancelled: nothing was made")
            self._done.set()
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
