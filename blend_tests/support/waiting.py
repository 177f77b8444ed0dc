# SPDX-License-Identifier: GPL-3.0-or-later
"""Waiting for other threads with a limit so long that it passes only if the thread never
answers.
"""

import pytest

LIMIT = 120  # seconds


def wait_for(awaited):
    """Waits for an Event, or for a Job to be done."""
    if not awaited.wait(LIMIT):
        pytest.fail(f"{awaited} has not come after {LIMIT} s")
