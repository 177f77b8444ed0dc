# SPDX-License-Identifier: Apache-2.0
"""What Ctrl-C does to a program that is within a long call."""

import os
import signal
import subprocess
import sys
import threading

import pytest

#: Seconds after which a program that was interrupted, and still runs, counts as deaf
LIMIT = 120
#: Signals that a call must hear one after the other. Python itself looks for one before a call and
#: for one behind it; whoever hears more than that listens while it works.
TIMES = 5


def errors_of(program):
    """What it wrote to stderr, having been sent Ctrl-C when it said "ready"."""
    with _started(program) as child:
        assert child.stdout.readline() == "ready\n"
        child.send_signal(signal.SIGINT)
        return _outputs(child)[1]


def output_of(program):
    """The lines that it wrote. It begins with `import ctrl_c` and calls `interrupt`."""
    with _started(program) as child:
        out, errors = _outputs(child)
    assert child.returncode == 0, errors
    return out.splitlines()


def interrupt(call):
    """Within the program: presses Ctrl-C again and again while `call` runs. The call is left to
    itself until it has heard that TIMES times, then the signal raises KeyboardInterrupt."""
    heard = threading.Semaphore(0)
    count = 0
    over = False

    def hear(_signal, _frame):
        nonlocal count
        count += 1
        if count == TIMES and not over:
            raise KeyboardInterrupt
        heard.release()

    def press():
        for _ in range(TIMES):
            os.kill(os.getpid(), signal.SIGINT)
            heard.acquire()

    signal.signal(signal.SIGINT, hear)
    threading.Thread(target=press, daemon=True).start()
    try:
        call()
        over = True
        print("finished, having heard", count)
    except KeyboardInterrupt:
        print("interrupted")


def _started(program):
    return subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        # Tests that a shell has started in the background ignore it, and so would their programs.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


def _outputs(child):
    try:
        return child.communicate(timeout=LIMIT)
    except subprocess.TimeoutExpired:
        child.kill()
        pytest.fail(f"It still runs {LIMIT} s after Ctrl-C")
