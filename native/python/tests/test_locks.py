# SPDX-License-Identifier: Apache-2.0
"""Threads that share a surface, functions that call back into it, forks and subinterpreters."""

import gc
import os
import subprocess
import sys
import textwrap
import threading

import limitsurf as ls
import numpy as np
import pytest
import shapes

#: Seconds after which a program that should end at once counts as hanging
LIMIT = 120


def run(program, *arguments):
    """What a program of its own wrote, which must end and return 0."""
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program), *arguments],
        capture_output=True,
        text=True,
        timeout=LIMIT,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def opened():
    return ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.house()))


def everywhere(surface, count):
    rng = np.random.default_rng(0)
    return rng.integers(0, surface.face_count, count), rng.random((count, 2))


def surface_and_setter():
    surface = opened()
    positions = surface.positions
    at = everywhere(surface, 300_000)
    return lambda: surface.evaluate(*at), lambda i: surface.set_positions(positions + i)


def data_and_setter():
    surface = opened()
    values = np.arange(len(surface.positions), dtype=float)
    data = surface.vertex_data(values)
    at = everywhere(surface, 300_000)
    return lambda: data.evaluate(*at), lambda i: data.set_values(values + i)


@pytest.mark.parametrize("make", [surface_and_setter, data_and_setter])
def test_who_sets_gets_in_before_readers_that_came_later(make):
    """Readers begin again and again. Each one may be under way when the other thread comes, and
    end after it; but it cannot begin once more before that."""
    read, write = make()
    begun = [0, 0, 0]
    over = threading.Event()

    def loop(i):
        while not over.is_set():
            begun[i] += 1
            read()

    readers = [threading.Thread(target=loop, args=(i,)) for i in range(3)]
    for reader in readers:
        reader.start()
    try:
        while min(begun) < 2:
            pass
        overtaken = []
        for i in range(20):
            before = list(begun)
            write(i)
            overtaken.append(max(b - a for a, b in zip(before, begun, strict=True)))
    finally:
        over.set()
        for reader in readers:
            reader.join()
    # One that has begun in Python may not have come to the lock yet, or have ended already: 2 each.
    # Where readers overtake, dozens begin before none is under way.
    assert max(overtaken) <= 4, overtaken


def calls_back(function):
    """Calls that call `function` while they read, by name."""
    surface = opened()
    positions = surface.positions

    def progress(_part):
        function(surface)

    def density(face, _uv):
        function(surface)
        return np.ones(len(face))

    return surface, {
        "closest": lambda: surface.closest(positions, progress=progress),
        "scatter_uniform": lambda: surface.scatter_uniform(50, density=density),
        "tessellate": lambda: surface.tessellate(2, progress=progress),
        "scatter_blue_noise": lambda: surface.scatter_blue_noise(count=50, progress=progress),
    }


@pytest.mark.parametrize("name", calls_back(None)[1])
def test_functions_may_read_what_their_caller_reads(name):
    seen = []
    _, calls = calls_back(lambda surface: seen.append(surface.evaluate(0, [[0.5, 0.5]]).position))
    calls[name]()
    assert len(seen) > 0


@pytest.mark.parametrize("name", calls_back(None)[1])
def test_functions_must_not_set_what_their_caller_reads(name):
    surface, calls = calls_back(lambda surface: surface.set_positions(surface.positions + 1))
    before = surface.positions
    with pytest.raises(RuntimeError, match=r"LimitSurface.*wait for itself"):
        calls[name]()
    np.testing.assert_array_equal(surface.positions, before)
    surface.set_positions(before + 1)


def test_destructors_that_the_garbage_collector_runs_may_call():
    """A cycle is collected within a progress function; its destructor sets positions."""
    raised = []
    surface = opened()

    class Cycle:
        def __init__(self):
            self.me = self

        def __del__(self):
            surface.evaluate(0, [[0.5, 0.5]])
            try:
                surface.set_positions(surface.positions)
            except RuntimeError as error:
                raised.append(str(error))

    def progress(_part):
        Cycle()
        gc.collect()

    surface.closest(surface.positions, progress=progress)
    assert raised
    assert "wait for itself" in raised[0]


SIGNAL = """
    import signal, sys, threading, time
    import numpy as np
    import limitsurf as ls
    import ctrl_c, shapes

    positions, faces = shapes.grid(60, 60)
    positions = positions * 1.0
    edges = np.vstack([faces[:, [0, 1]], faces[:, [0, 3]]])
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(
        positions, faces, edge_sharpness=(edges, np.full(len(edges), 2.5))))
    data = surface.vertex_data(np.ones((len(positions), 12)))

    def handle(*_):
        try:
            {inner}
            print("answered", flush=True)
        except RuntimeError as error:
            print(str(error), flush=True)
        raise KeyboardInterrupt

    signal.signal(signal.SIGALRM, handle)
    signal.setitimer(signal.ITIMER_REAL, 0.05)
    try:
        while True:
            {outer}
    except KeyboardInterrupt:
        pass
    surface.evaluate(0, [[0.5, 0.5]])
    surface.set_positions(positions)
    data.set_values(np.ones((len(positions), 12)))
    print("goes on")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no timer signals")
@pytest.mark.parametrize(
    "outer", ["evaluate(0, np.random.rand(3_000_000, 2))", "set_positions(positions)"]
)
@pytest.mark.parametrize(
    "inner", ["set_positions(positions)", "evaluate(0, [[0.5, 0.5]])", "closest([[0, 0, 1]])"]
)
def test_signal_handlers_that_call_the_same_surface(outer, inner):
    out = run(SIGNAL.format(outer=f"surface.{outer}", inner=f"surface.{inner}")).splitlines()
    assert out[-1] == "goes on"
    # Readers may read. The signal may also have come between two calls.
    assert out[0] == "answered" or "wait for itself" in out[0]


def test_two_threads_that_wait_for_each_other():
    """Each reads one surface and sets the other one from a progress function."""
    a, b = opened(), opened()
    both = threading.Barrier(2, timeout=LIMIT)
    raised = []

    def work(reads, sets):
        first = True

        def progress(_part):
            nonlocal first
            if first:
                first = False
                both.wait()
                sets.set_positions(sets.positions)

        try:
            reads.closest(reads.positions, progress=progress)
        except RuntimeError as error:
            raised.append(str(error))

    threads = [threading.Thread(target=work, args=pair) for pair in ((a, b), (b, a))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(LIMIT)
        assert not thread.is_alive()
    assert len(raised) == 1
    assert "wait for itself" in raised[0]


SUBINTERPRETER = """
    try:
        import _interpreters as interpreters
    except ImportError:
        import _xxsubinterpreters as interpreters
    other = interpreters.create()
    program = '''if True:
        for name in ("limitsurf._limitsurf", "limitsurf"):
            try:
                __import__(name)
            except ImportError as error:
                print(error, flush=True)
    '''
    failed = (getattr(interpreters, "run_string", None) or interpreters.exec)(other, program)
    assert not failed, failed
    import limitsurf
    print("main", limitsurf.__version__)
"""


def test_subinterpreters_are_refused():
    lines = run(SUBINTERPRETER).splitlines()
    assert len(lines) == 3
    assert "subinterpreter" in lines[0]
    assert "subinterpreter" in lines[1]
    assert lines[2].startswith("main")


FORK = """
    import os, sys, threading
    import numpy as np
    import limitsurf as ls
    import shapes

    positions, faces = shapes.grid(60, 60)
    positions = positions * 1.0
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    uv = np.random.default_rng(0).random((200_000, 2))
    expected = surface.evaluate(0, uv).position
    under_way, go_on = threading.Event(), threading.Event()

    def progress(part):
        under_way.set()
        go_on.wait()

    thread = threading.Thread(target=lambda: surface.closest(positions[:3], progress=progress))
    if sys.argv[1] == "busy":
        thread.start()
        under_way.wait()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            assert (surface.evaluate(0, uv).position == expected).all()  # readers may read on
            assert (surface.closest(positions[:9]).distance < 1).all()
            ls.LimitSurface(surface.mesh).tessellate(2)
            try:
                surface.set_positions(positions)
                assert sys.argv[1] == "idle"
            except RuntimeError as error:
                assert sys.argv[1] == "busy"
                assert "forked" in str(error), error
            code = 0
        finally:
            os._exit(code)
    go_on.set()
    if sys.argv[1] == "busy":
        thread.join()
    surface.set_positions(positions)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
@pytest.mark.parametrize("parent", ["idle", "busy"])
def test_forked_children(parent):
    assert run(FORK, parent).splitlines() == ["0"]
