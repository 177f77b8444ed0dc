# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C within calls that change something: it is heard while they work, and leaves things as they
were before.
"""

import itertools
import pickle
import signal
import sys
import threading

import limitsurf as ls
import numpy as np
import pytest
import shapes

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no timer signals")

#: Seconds between two signals. Calls look for them every 20 ms.
TICK = 0.005
#: The most calls in a row that may end before they have heard as many signals as they should.
TRIES = 20


class InterruptedCallError(Exception):
    pass


def interrupt(call, hearings):
    """Calls `call` until it has heard so many signals, the last of which raises. Python itself
    looks for one before a call and for one after it: who hears three listens while it works.
    """
    heard = 0

    def hear(_signal, _frame):
        nonlocal heard
        heard += 1
        if heard == hearings:
            signal.setitimer(signal.ITIMER_REAL, 0)
            raise InterruptedCallError

    before = signal.signal(signal.SIGALRM, hear)
    try:
        for calls in range(1, TRIES + 1):
            heard = 0
            signal.setitimer(signal.ITIMER_REAL, TICK, TICK)
            for _ in range(calls):  # a fast machine may end one before enough signals have come
                call()
    except InterruptedCallError:
        return
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    pytest.fail(f"It never heard {hearings} signals")


def triangles(side):
    positions, quads = shapes.grid(side, side)
    return positions * 1.0, shapes.halves(quads)


@pytest.fixture(scope="module")
def shared():
    positions, faces = triangles(150)
    return ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))


@pytest.fixture
def surface(shared):
    shared.set_positions(shared.mesh.positions)
    return shared


def everywhere(surface):
    rng = np.random.default_rng(0)
    return rng.integers(0, surface.face_count, 5000), rng.random((5000, 2))


def pose_of(surface):
    """How to give the surface another pose, and what follows from its pose."""
    at = everywhere(surface)
    larger = 3 * surface.positions + 1

    def change():
        for _ in range(6):  # one alone is over before several signals have come
            surface.set_positions(larger, 1)

    def evaluated():
        return surface.evaluate(*at, 2).dvv.tobytes() + surface.positions.tobytes()

    return change, evaluated


def values_on(surface):
    """How to give data other values, and what follows from the values."""
    at = everywhere(surface)
    rng = np.random.default_rng(1)
    data = surface.vertex_data(rng.random((len(surface.positions), 10)))
    others = rng.random((len(surface.positions), 10))
    return lambda: data.set_values(others, 1), lambda: data.evaluate(*at).value.tobytes()


HEARINGS = (3, 4, 5, 6, 8)


@pytest.mark.parametrize("hearings", HEARINGS)
@pytest.mark.parametrize("of", [pose_of, values_on])
def test_what_is_interrupted_is_as_before_or_as_asked(surface, of, hearings):
    change, evaluated = of(surface)
    before = evaluated()
    interrupt(change, hearings)
    after = evaluated()
    if after != before:  # one change had ended, and a later one was interrupted
        change()
        assert evaluated() == after


def test_some_interruptions_come_before_the_change(surface):
    """The test above would pass if changes always came to their end."""
    change, evaluated = values_on(surface)
    before = evaluated()
    interrupt(change, HEARINGS[0])
    assert evaluated() == before


def test_readers_never_see_half_a_pose(surface):
    at = everywhere(surface)
    poses = [surface.positions, 2 * surface.positions]
    expected = set()
    for pose in poses[::-1]:
        surface.set_positions(pose)
        expected.add(surface.evaluate(*at).position.tobytes())
    wrong, rounds = [], [0, 0]
    over = threading.Event()

    def read(i):
        while not over.is_set():
            if surface.evaluate(*at, threads=1).position.tobytes() not in expected:
                wrong.append(i)
            rounds[i] += 1

    readers = [threading.Thread(target=read, args=(i,)) for i in range(2)]
    for reader in readers:
        reader.start()
    try:
        turns = itertools.cycle(poses[::-1])
        for hearings in HEARINGS:
            interrupt(lambda: [surface.set_positions(next(turns), 1) for _ in range(3)], hearings)
            before = list(rounds)
            while any(now < then + 2 for now, then in zip(rounds, before, strict=True)):
                pass
    finally:
        over.set()
        for reader in readers:
            reader.join()
    assert not wrong


def test_a_second_interruption_while_the_pose_is_mended(surface):
    change, evaluated = pose_of(surface)
    before = evaluated()
    for _ in range(3):
        interrupt(change, 3)
        try:
            interrupt(lambda: surface.evaluate(0, [[0.5, 0.5]]), 2)
        except pytest.fail.Exception:
            continue  # it was mended before a second signal came
    after = evaluated()
    if after != before:
        change()
        assert evaluated() == after


def large_mesh():
    positions, faces = shapes.grid(800, 800)
    return ls.ControlMesh.from_faces(positions * 1.0, faces)


def large_mesh_with_fin():
    """It is not manifold, and has more corners than OpenSubdiv connects at once without being heard
    meanwhile."""
    positions, faces = shapes.grid(400, 400)
    middle = faces[400 * 200 + 200]
    fin = [middle[0], middle[1], len(positions), len(positions) + 1]
    return ls.ControlMesh.from_faces(
        np.vstack(
            [positions * 1.0, positions[middle[1]] + [0, 0, 1], positions[middle[0]] + [0, 0, 1]]
        ),
        np.vstack([faces, fin]),
    )


def stored(surface):
    state = pickle.dumps(surface)
    return lambda: pickle.loads(state)


def opening(mesh):
    return lambda: ls.LimitSurface(mesh)


def tiling(surface):
    at = everywhere(surface)
    return lambda: surface.tiles(*at, threads=1)


CALLS = {
    "LimitSurface": lambda s: opening(s.mesh),
    "LimitSurface, large": lambda _: opening(large_mesh()),
    "LimitSurface, not manifold": lambda _: opening(large_mesh_with_fin()),
    "pickle": stored,
    "vertex_data": lambda s: lambda: s.vertex_data(np.ones((len(s.positions), 6)), threads=1),
    "face_varying": lambda s: (
        lambda: s.face_varying(s.positions, s.mesh.face_vertices, "boundaries", threads=1)
    ),
    "from_faces, lists": lambda _: from_lists(),
    "edge_sharpness": lambda _: sharp_edges(),
    "tiles": tiling,
}


def from_lists():
    positions, faces = triangles(300)
    lists = faces.tolist()
    return lambda: ls.ControlMesh.from_faces(positions, lists)


def sharp_edges():
    positions, faces = shapes.grid(1000, 1000)
    edges = np.vstack([faces[:, [0, 1]], faces[:, [0, 3]]])
    sharpness = (edges, np.ones(len(edges)))
    return lambda: ls.ControlMesh.from_faces(positions, faces, edge_sharpness=sharpness)


@pytest.mark.parametrize("name", CALLS)
def test_calls_that_make_something_are_not_deaf(surface, name):
    interrupt(CALLS[name](surface), 3)
