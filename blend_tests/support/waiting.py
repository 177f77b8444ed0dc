# SPDX-License-Identifier: GPL-3.0-or-later
"""Waiting for other threads: however busy the machine is, only what never comes is a failure."""

import pytest

LIMIT = 120  # seconds


def wait_for(awaited):
    """For an Event, or for a Job to be done."""
    if not awaited.wait(LIMIT):
        pytest.fail(f"{awaited} has not come after {LIMIT} s")
