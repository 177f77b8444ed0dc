# SPDX-License-Identifier: Apache-2.0
"""Measures how long calls of the module `limitsurf` keep other Python threads waiting, and how soon
Ctrl-C ends them. Prints a table in Markdown.

    .venv/bin/python tools/bench_interrupts.py
"""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import limitsurf as ls
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "native/python/tests"))

import shapes  # noqa: E402

LET_RUN = 1.0  # seconds before Ctrl-C
LOOK = 0.001  # seconds between two readings of the clock by the other thread


def calls() -> dict[str, Callable[[], object]]:
    """Returns calls, each of which would take tens of seconds or more."""
    around = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.pole(200)))
    near = np.tile([[1e-4, 2e-4]], (4_000_000, 1))
    positions, faces = shapes.grid(300, 300)
    edges = np.vstack([faces[:, [0, 1]], faces[:, [0, 3]]])
    sharp = ls.ControlMesh.from_faces(
        positions, faces, edge_sharpness=(edges, np.full(len(edges), 6.5))
    )
    positions = positions * 1.0
    positions[:, 2] = np.sin(positions[:, 0] * positions[:, 1])
    rough = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    points = np.random.default_rng(0).uniform(-100, 200, (5_000_000, 3))
    rough.closest(points[:1])
    return {
        "evaluate": lambda: around.evaluate(0, near),
        "frames": lambda: around.frames(0, near),
        "curvature": lambda: around.curvature(0, near),
        "LimitSurface(mesh)": lambda: ls.LimitSurface(sharp),
        "closest": lambda: rough.closest(points),
        "ray_cast": lambda: rough.ray_cast(points, points),
    }


def measured(call: Callable[[], object]) -> tuple[float, float] | None:
    """Returns in seconds the longest pause of another thread, and the time from Ctrl-C to the end;
    None where the call had ended before.
    """
    over = threading.Event()
    longest, asked = 0.0, 0.0

    def watch() -> None:
        nonlocal longest, asked
        begin = last = time.perf_counter()
        while not over.is_set():
            time.sleep(LOOK)
            now = time.perf_counter()
            longest, last = max(longest, now - last), now
            if not asked and now - begin > LET_RUN:
                asked = now
                os.kill(os.getpid(), signal.SIGINT)

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        call()
    except KeyboardInterrupt:
        return longest, time.perf_counter() - asked
    else:
        return None
    finally:
        over.set()
        watcher.join()


def main() -> None:
    print("| call | longest pause of another thread | until Ctrl-C has ended it |")
    print("|---|---:|---:|")
    for name, call in calls().items():
        found = measured(call)
        if found is None:
            print(f"| `{name}` | took less than {LET_RUN:g} s | |")
        else:
            pause, end = found
            print(f"| `{name}` | {1000 * pause:.0f} ms | {1000 * end:.0f} ms |")


if __name__ == "__main__":
    main()
