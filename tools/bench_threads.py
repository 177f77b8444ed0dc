# SPDX-License-Identifier: Apache-2.0
"""Times of calls of the Python module on one thread and on more, for `bench_report.py`."""

import os
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial

import limitsurf
import numpy as np

#: Rows of each call; a call of another size has a factor for its time
COUNT = 1_000_000
REPEATS = 5
SIDE, LARGE_SIDE = 100, 1000
BLUE_NOISE = 100_000
STENCILS = 200_000
#: A call takes the number of threads
Call = Callable[[int], object]


def measured() -> dict[str, dict[int, float]]:
    """Returns the seconds of each call by the number of threads, for up to all of them."""
    found = {}
    counts = thread_counts()
    for name, call in {**calls(), **large_calls()}.items():
        print(name, flush=True)
        found[name] = interleaved(clocked(call), counts)
    print(OPENING, flush=True)
    found[OPENING] = interleaved(opened_on, counts)
    return found


def thread_counts() -> list[int]:
    """Returns powers of two up to the number of cores, and that number."""
    cores = len(os.sched_getaffinity(0))
    return sorted({1 << i for i in range(cores.bit_length())} | {cores})


def clocked(call: Call) -> Callable[[int], float]:
    def seconds(threads: int) -> float:
        begin = time.perf_counter()
        call(threads)
        return time.perf_counter() - begin

    return seconds


def interleaved(seconds: Callable[[int], float], counts: list[int]) -> dict[int, float]:
    """Returns the least of some times for each number of threads. The numbers take turns, so that a
    machine that becomes slower is so for all of them.
    """
    times: dict[int, list[float]] = {count: [] for count in counts}
    for _ in range(REPEATS):
        for count in counts:
            times[count].append(seconds(count))
    return {count: min(values) for count, values in times.items()}


def table(found: dict[str, dict[int, float]]) -> str:
    """Returns the table of the page: ns per row on one thread and on all of them."""
    lines = ["| Python | one thread | all threads | ratio |", "|---|---:|---:|---:|"]
    for name, seconds in found.items():
        ns = {count: 1e9 / ROWS.get(name, COUNT) * value for count, value in seconds.items()}
        one, most = ns[1], ns[max(ns)]
        lines.append(f"| {name} | {one:.3g} | {most:.3g} | {one / most:.2f} |")
    return "\n".join([*lines, ""])


def sheet(side: int) -> limitsurf.ControlMesh:
    """Returns a wavy, regular mesh of side x side quads."""
    y, x = np.mgrid[: side + 1, : side + 1].astype(float)
    z = 8 * np.sin(9 * x / side) * np.cos(7 * y / side)
    first = (y[:-1, :-1] * (side + 1) + x[:-1, :-1]).astype(int).ravel()
    faces = np.stack([first, first + 1, first + side + 2, first + side + 1], 1)
    return limitsurf.ControlMesh.from_faces(np.stack([x, y, z], -1).reshape(-1, 3), faces)


def calls() -> dict[str, Call]:
    mesh = sheet(SIDE)
    surface = limitsurf.LimitSurface(mesh)
    rng = np.random.default_rng(1)
    face, uv = np.sort(rng.integers(0, SIDE**2, COUNT)), rng.random((COUNT, 2))
    near = surface.evaluate(face, uv).position + rng.normal(scale=0.1, size=(COUNT, 3))
    shuffled = rng.permutation(COUNT)
    random_face, random_uv = face[shuffled], uv[shuffled]
    origins = near[shuffled] + [0, 0, 100]
    down = np.tile([0.0, 0, -1], (COUNT, 1))
    far = near[shuffled] + rng.normal(scale=3.0, size=(COUNT, 3))
    evaluate, single = surface.evaluate, np.float32
    data = surface.vertex_data(surface.positions[:, :2])
    return {
        "evaluate, P": lambda threads: evaluate(face, uv, threads=threads),
        "evaluate, P with du, dv and normals": lambda threads: evaluate(
            face, uv, 1, threads=threads
        ),
        "the same in float32": lambda threads: evaluate(face, uv, 1, threads=threads, dtype=single),
        "P with du, dv and normals, faces in random order": lambda threads: evaluate(
            random_face, random_uv, 1, threads=threads
        ),
        "evaluate, second derivatives too": lambda threads: evaluate(face, uv, 2, threads=threads),
        "frames": lambda threads: surface.frames(face, uv, threads=threads),
        "data of two columns": lambda threads: data.evaluate(face, uv, threads=threads),
        "stencils": lambda threads: surface.stencils(
            face[:STENCILS], uv[:STENCILS], threads=threads
        ),
        "closest, within a tenth of an edge": lambda threads: surface.closest(
            near, threads=threads
        ),
        "closest, within some edges, random order": lambda threads: surface.closest(
            far, threads=threads
        ),
        "ray_cast, from above": lambda threads: surface.ray_cast(origins, down, threads=threads),
        "scatter_uniform": lambda threads: surface.scatter_uniform(COUNT, seed=1, threads=threads),
        "scatter_blue_noise": lambda threads: surface.scatter_blue_noise(
            count=BLUE_NOISE, seed=1, threads=threads
        ),
    }


def large_calls() -> dict[str, Call]:
    surface = limitsurf.LimitSurface(sheet(LARGE_SIDE))
    positions = np.array(surface.positions)
    return {
        "set_positions, a million quads": partial(_repose, surface, positions),
        "area, a million quads": lambda threads: surface.area(threads=threads),
    }


def _repose(surface: limitsurf.LimitSurface, positions: np.ndarray, threads: int) -> None:
    surface.set_positions(positions, threads=threads)


OPENING = "opening, a million quads"
#: What is drawn against the number of threads
DRAWN = (
    "evaluate, P with du, dv and normals",
    "P with du, dv and normals, faces in random order",
    "frames",
    "closest, within some edges, random order",
    "ray_cast, from above",
    "scatter_uniform",
    "scatter_blue_noise",
    "set_positions, a million quads",
    OPENING,
)
#: Rows of the calls that have not COUNT of them
ROWS = {
    "stencils": STENCILS,
    "scatter_blue_noise": BLUE_NOISE,
    "set_positions, a million quads": LARGE_SIDE**2,
    "area, a million quads": LARGE_SIDE**2,
    OPENING: LARGE_SIDE**2,
}


def opened_on(cores: int) -> float:
    """Returns the wall time of opening a mesh in a process that may use so many cores: opening
    itself takes no number of threads.
    """
    allowed = sorted(os.sched_getaffinity(0))[:cores]
    program = [sys.executable, __file__, *(str(core) for core in allowed)]
    done = subprocess.run(program, stdout=subprocess.PIPE, text=True, check=True)
    return float(done.stdout)


def _open(cores: set[int]) -> None:
    os.sched_setaffinity(0, cores)  # before the first call, which makes the threads
    mesh = sheet(LARGE_SIDE)
    begin = time.perf_counter()
    limitsurf.LimitSurface(mesh)
    print(time.perf_counter() - begin)


if __name__ == "__main__":
    _open({int(core) for core in sys.argv[1:]})
