# SPDX-License-Identifier: Apache-2.0
"""Long calls leave Python running and can be interrupted."""

import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import limitsurf as ls
import numpy as np
import pytest
import shapes


@pytest.fixture(scope="module")
def slow_place():
    """A surface, and a location on it whose evaluation costs microseconds."""
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.pole(200)))
    return surface, (0, 1e-4, 2e-4)


def rows_that_take(seconds, surface, place):
    face, u, v = place
    uv = np.tile([[u, v]], (20_000, 1))
    surface.evaluate(face, uv)
    start = time.perf_counter()
    surface.evaluate(face, uv)
    rate = 20_000 / (time.perf_counter() - start)
    return np.tile([[u, v]], (int(min(8e6, rate * seconds)), 1))


def test_other_threads_run_meanwhile(slow_place):
    surface, place = slow_place
    uv = rows_that_take(1.0, surface, place)
    done = threading.Event()

    def work():
        surface.evaluate(place[0], uv)
        done.set()

    worker = threading.Thread(target=work)
    start = time.perf_counter()
    worker.start()
    longest, last = 0.0, start
    while not done.is_set():
        time.sleep(0.001)
        now = time.perf_counter()
        longest, last = max(longest, now - last), now
    worker.join()
    assert longest < 0.5 * (last - start), f"Python stood still for {longest:.2f} s"


def test_threads_may_share_a_surface():
    positions, faces = shapes.house()
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    rng = np.random.default_rng(0)
    face, uv = rng.integers(0, surface.face_count, 2000), rng.random((2000, 2))
    poses = [positions, positions + 1]
    expected = []
    for pose in poses:
        surface.set_positions(pose)
        expected.append(surface.evaluate(face, uv).position.tobytes())
    wrong = []
    stop = threading.Event()

    def evaluate():
        while not stop.is_set():
            if surface.evaluate(face, uv).position.tobytes() not in expected:
                wrong.append(1)

    workers = [threading.Thread(target=evaluate) for _ in range(3)]
    for worker in workers:
        worker.start()
    for i in range(200):
        surface.set_positions(poses[i % 2])
    stop.set()
    for worker in workers:
        worker.join()
    assert not wrong


INTERRUPTED = """
import sys, time
sys.path.insert(0, {folder!r})
import limitsurf as ls, numpy as np, shapes, test_threads
surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.pole(200)))
place = (0, 1e-4, 2e-4)
uv = test_threads.rows_that_take(30, surface, place)
call = getattr(surface, {method!r})
print("go", flush=True)
start = time.perf_counter()
try:
    call(place[0], uv)
except KeyboardInterrupt:
    print("interrupted", time.perf_counter() - start, flush=True)
else:
    print("finished", time.perf_counter() - start, flush=True)
print(surface.evaluate(0, [[0.5, 0.5]]).position.shape)
"""


OPENING = """
import sys, time
import limitsurf as ls, numpy as np
side = 300  # every edge sharp for some steps: seconds of refinement
x, y = np.meshgrid(np.arange(side + 1), np.arange(side + 1))
corner = (y * (side + 1) + x)[:-1, :-1].ravel()
faces = corner[:, None] + [0, 1, side + 2, side + 1]
edges = np.vstack([faces[:, [0, 1]], faces[:, [0, 3]]])
mesh = ls.ControlMesh.from_faces(
    np.c_[x.ravel(), y.ravel(), np.zeros(x.size)],
    faces,
    edge_sharpness=(edges, np.full(len(edges), 6.5)),
)
print("go", flush=True)
start = time.perf_counter()
try:
    ls.LimitSurface(mesh)
except KeyboardInterrupt:
    print("interrupted", time.perf_counter() - start, flush=True)
else:
    print("finished", time.perf_counter() - start, flush=True)
small = ls.LimitSurface(ls.ControlMesh.from_faces(np.eye(3), [[0, 1, 2]]))
print(small.evaluate(0, [[0.5, 0.5]]).position.shape)
"""


def interrupted(code):
    """Its output lines after "go", having been sent Ctrl-C."""
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    try:
        assert child.stdout.readline() == "go\n"
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        out, _ = child.communicate(timeout=60)
    finally:
        child.kill()
    assert child.returncode == 0
    return out.splitlines()


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one process")
@pytest.mark.parametrize("method", ["evaluate", "frames", "curvature", "opening"])
def test_ctrl_c_stops_a_long_call(method):
    folder = str(Path(__file__).parent)
    lines = interrupted(
        OPENING if method == "opening" else INTERRUPTED.format(folder=folder, method=method)
    )
    word, seconds = lines[0].split()
    assert word == "interrupted"
    assert float(seconds) < 8
    assert lines[1] == "(1, 3)", "a surface still works"
