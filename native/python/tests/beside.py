# SPDX-License-Identifier: Apache-2.0
"""Whether other threads run Python while one is within a long call."""

import sys
import threading
import time

import pytest

#: Calls after which nothing is expected any more
CALLS = 1000
LOOKS = 5
#: Seconds that a thread may keep the GIL: for ever. It then gives it up only where it waits, and
#: within calls that release it.
KEPT = 1000.0


def assert_python_goes_on(call):
    """Makes the call in another thread until this one, which can only run when the other has given
    up the GIL, has found it within a call some times."""
    begun, ended, looks = 0, 0, 0
    stop = False

    def work():
        nonlocal begun, ended
        for _ in range(CALLS):
            if stop:
                return
            begun += 1
            call()
            ended += 1

    worker = threading.Thread(target=work)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(KEPT)
    try:
        worker.start()
        while looks < LOOKS and worker.is_alive():
            looks += begun > ended
            time.sleep(0.001)
    finally:
        stop = True
        sys.setswitchinterval(interval)
        worker.join()
    if looks < LOOKS:
        pytest.fail(f"Python stood still during {ended} calls")
