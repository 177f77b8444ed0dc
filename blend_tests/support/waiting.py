# SPDX-License-Identifier: GPL-3.0-or-later
"""Waiting for other threads with a limit so long that it passes only if the thread never
answers.
"""

import time
from collections.abc import Callable

import pytest

LIMIT = 120  # seconds


def wait_for(awaited):
    """Waits for an Event, or for a Job to be done."""
    if not awaited.wait(LIMIT):
        pytest.fail(f"{awaited} has not come after {LIMIT} s")


def wait_until(condition: Callable[[], bool], what: str) -> None:
    deadline = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > deadline:
            pytest.fail(f"{what}: not after {LIMIT} s")
        time.sleep(0.01)
