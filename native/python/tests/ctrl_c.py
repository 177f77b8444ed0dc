# SPDX-License-Identifier: Apache-2.0
"""What Ctrl-C does to a program."""

import os
import signal
import subprocess
import sys


def errors_of(program):
    """What it wrote to stderr, having been sent Ctrl-C when it said "ready"."""
    child = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert child.stdout.readline() == "ready\n"
    child.send_signal(signal.SIGINT)
    return child.communicate(timeout=60)[1]
