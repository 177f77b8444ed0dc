# SPDX-License-Identifier: Apache-2.0
"""Python ends while threads that it does not wait for are within calls."""

import os
import subprocess
import sys

import pytest

#: Each call gives up the GIL in its own way.
CALLS = {
    "evaluate": "surface.evaluate(0, at)",
    "make": "ls.LimitSurface(ls.ControlMesh.from_faces(square, [[0, 1, 2, 3]]))",
    "lists": "surface.evaluate(0, at[:2000].tolist())",
    "progress": "surface.closest(points, progress=lambda part: sum(range(1000)))",
    "density": "surface.scatter_uniform(1000, density=lambda face, uv: np.sin(uv).sum(1))",
}

PROGRAM = """
import threading, time
import limitsurf as ls, numpy as np

square = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
surface = ls.LimitSurface(ls.ControlMesh.from_faces(square, [[0, 1, 2, 3]]))
at = np.random.default_rng(0).random((100_000, 2))
points = np.random.default_rng(0).random((10_000, 3))

def work():
    while True:
        {call}

for _ in range(3):
    threading.Thread(target=work, daemon=True).start()
time.sleep(0.3)
"""

CALLED_LAST = """
import limitsurf as ls

square = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
surface = ls.LimitSurface(ls.ControlMesh.from_faces(square, [[0, 1, 2, 3]]))

class Last:
    def __del__(self, surface=surface):
        print(surface.bounds().shape, len(surface.edge_curves()))

last = Last()
"""


def output_of(program):
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.mark.parametrize("name", CALLS)
def test_python_ends_during_calls_of_other_threads(name):
    for _ in range(3):  # each time the threads are somewhere else
        output_of(PROGRAM.format(call=CALLS[name]))


def test_the_thread_that_ends_python_may_call():
    assert output_of(CALLED_LAST) == "(2, 3) 1\n"
