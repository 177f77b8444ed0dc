# SPDX-License-Identifier: Apache-2.0
"""Long calls leave Python running and can be interrupted."""

import sys
import threading

import beside
import ctrl_c
import limitsurf as ls
import numpy as np
import pytest
import shapes


def test_other_threads_run_meanwhile():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.pole(200)))
    uv = np.tile([[1e-4, 2e-4]], (20_000, 1))  # microseconds each
    beside.assert_python_goes_on(lambda: surface.evaluate(0, uv))


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


EVALUATING = """
import ctrl_c, limitsurf as ls, numpy as np, shapes
surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.pole(200)))
uv = np.tile([[1e-25, 2e-25]], (4_000_000, 1))  # minutes
ctrl_c.interrupt(lambda: surface.{method}(0, uv))
print(surface.evaluate(0, [[0.5, 0.5]]).position.shape)
"""


OPENING = """
import ctrl_c, limitsurf as ls, numpy as np, shapes
positions, faces = shapes.grid(300, 300)  # every edge sharp for some steps: seconds of refinement
edges = np.vstack([faces[:, [0, 1]], faces[:, [0, 3]]])
mesh = ls.ControlMesh.from_faces(
    positions, faces, edge_sharpness=(edges, np.full(len(edges), 6.5))
)
ctrl_c.interrupt(lambda: ls.LimitSurface(mesh))
small = ls.LimitSurface(ls.ControlMesh.from_faces(np.eye(3), [[0, 1, 2]]))
print(small.evaluate(0, [[0.5, 0.5]]).position.shape)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one process")
@pytest.mark.parametrize("method", ["evaluate", "frames", "curvature", "opening"])
def test_ctrl_c_stops_a_long_call(method):
    program = OPENING if method == "opening" else EVALUATING.format(method=method)
    first, then = ctrl_c.output_of(program)
    assert first == "interrupted"
    assert then == "(1, 3)", "a surface still works"
