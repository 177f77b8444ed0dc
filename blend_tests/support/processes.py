# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs that run in a Blender module of their own, apart from that of the tests."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Blender's clean-up at exit can hang after a Python error, so the process ends at once, with the
# right code.
LEAVE = """
import os, sys, traceback
def leave(*error):
    traceback.print_exception(*error)
    sys.stderr.flush()
    os._exit(1)
sys.excepthook = leave
{program}
sys.stdout.flush()
sys.stderr.flush()
os._exit(0)
"""


def run_python(
    program: str, *options: str, timeout: float = 120, **environment: str
) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(
        [sys.executable, *options, "-c", LEAVE.format(program=program)],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=timeout,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done
