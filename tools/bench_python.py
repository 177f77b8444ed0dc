# SPDX-License-Identifier: Apache-2.0
"""Compares calls of the Python module with the same calls in C++: evaluation, opening, new
positions and searches, on the same meshes, at the same places, with results in newly allocated
memory. (Python's calls compute normals together with derivatives; those in C++ do not.) Prints a
table in Markdown, with ns of CPU time a sample, a face or a search.

    .venv/bin/python tools/bench_python.py [ROW ...] [--samples N ...]

With names of rows ("regular", "open", "pose", "closest-near"), only those. C++ and Python take
turns in processes of their own, and each number is the least of some turns. Build
`limitsurf_bench` before; the machine should have nothing else to do.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from statistics import median

import limitsurf
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
BENCH = ROOT / "build/cpp/native/bench/limitsurf_bench"
EVALUATED = (
    "regular",
    "interior-EV",
    "boundary-EV",
    "corner",
    "multi-EV",
    "non-quad",
    "near-interior-EV",
    "near-boundary-EV",
    "near-corner",
    "mixed-20k-faces",
)
#: Rows of evaluation whose meshes are opened and posed as well
OPENED = ("multi-EV", "non-quad", "mixed-20k-faces")
#: Searches and their rows in the table of limitsurf_bench
SEARCHED = {
    "closest-far": "closest, to 5 % of the diagonal",
    "closest-near": "closest, to 5 % of a face's width",
    "rays-above": "rays, from above",
    "rays-all-sides": "rays, from all sides",
}
#: What is measured with whole meshes, and how the table calls it
SET_UP = {"open": "opening", "pose": "new positions"}
ROWS = (*EVALUATED, *SET_UP, *SEARCHED)
ORDERS = ("sorted", "random")
RESULTS = ("P", "P,D1", "P,D1,D2")  # their place is the order of the derivatives
SAMPLES = (100_000, 1_000_000)
SEARCHES = 1_000_000
TURNS = 3
REPEATS = 9
LEAST_SECONDS = 0.2
# The allocator returns all freed memory to the system. Otherwise it keeps some, after a while.
FRESH = {"MALLOC_MMAP_THRESHOLD_": "131072", "MALLOC_TRIM_THRESHOLD_": "131072"}

#: Nanoseconds by what was done
Times = dict[str, float]


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("rows", nargs="*", metavar="ROW", help=f"of {', '.join(ROWS)}")
    parser.add_argument("--samples", nargs="+", type=int, default=SAMPLES, metavar="N")
    options = parser.parse_args(arguments)
    for line in lines(options.rows or ROWS, options.samples):
        print(line, flush=True)


def lines(
    rows: Sequence[str], samples: Sequence[int] = SAMPLES, results: Sequence[str] = RESULTS
) -> Iterator[str]:
    """Yields the lines of the table."""
    yield "| what | samples | C++ | Python | Python / C++ |"
    yield "|---|---:|---:|---:|---:|"
    for count in samples:
        with tempfile.TemporaryDirectory() as folder:
            output(BENCH, f"--save={folder}", f"--samples={count}")
            for row in (row for row in EVALUATED if row in rows):
                cpp, python = partial(evaluated, row, count), partial(in_python, row, folder)
                for name, line in compared(cpp, python, f"{count:,}"):
                    if name.split()[-1] in results:
                        yield line
            if count == samples[-1]:
                for row in (row for row in SET_UP if row in rows):
                    of_meshes = compared(partial(set_up, row), partial(in_python, row, folder))
                    yield from (line for _name, line in of_meshes)
    with tempfile.TemporaryDirectory() as folder:
        searches = [row for row in SEARCHED if row in rows]
        if searches:
            output(BENCH, f"--save={folder}", f"--queries={SEARCHES}")
            python = partial(in_python, "searches", folder)
            for name, line in compared(searched, python, f"{SEARCHES:,}"):
                if name in searches:
                    yield line


def compared(
    cpp: Callable[[], Times], python: Callable[[], Times], samples: str = ""
) -> Iterator[tuple[str, str]]:
    """Yields names and lines."""
    turns = [(cpp(), python()) for _ in range(TURNS)]
    for name in turns[0][1]:
        ours, theirs = (min(turn[i][name] for turn in turns) for i in (1, 0))
        yield name, f"| {name} | {samples} | {theirs:.1f} | {ours:.1f} | {ours / theirs:.2f} |"


def cells_of(text: str) -> Iterator[list[str]]:
    """Yields the cells of all tables in a text, line by line."""
    for line in text.splitlines():
        if line.startswith("|"):
            yield [cell.strip() for cell in line.split("|")[1:-1]]


def evaluated(row: str, samples: int) -> Times:
    wanted = f"evaluate/{row}/.*/limitsurf"
    text = output(BENCH, "--fresh-memory", f"--samples={samples}", f"--benchmark_filter={wanted}")
    return {
        f"{row}, {cells[1]}: {cells[2]}": float(cells[3])
        for cells in cells_of(text)
        if cells[0] == row
    }


def set_up(what: str) -> Times:
    """Opening takes ns a face; new positions take ns an irregular one, here of those meshes that
    have no others.
    """
    wanted = f"^{what}/({'|'.join(OPENED)})/.*/limitsurf"
    text = output(BENCH, "--fresh-memory", f"--benchmark_filter={wanted}")
    return {
        f"{SET_UP[what]}, {cells[0]}": float(cells[3])
        for cells in cells_of(text)
        if cells[0] in OPENED
    }


def searched() -> Times:
    text = output(BENCH, f"--queries={SEARCHES}")
    rows = {row: name for name, row in SEARCHED.items()}
    return {
        rows[cells[0]]: 1e9 / SEARCHES * float(cells[2])
        for cells in cells_of(text)
        if cells[0] in rows
    }


def in_python(what: str, folder: str) -> Times:
    return json.loads(output(sys.executable, __file__, "--measure", what, folder))


def output(*command: str | Path) -> str:
    done = subprocess.run(
        command,
        env=os.environ | FRESH,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        check=True,
    )
    return done.stdout


def measure(what: str, folder: str) -> Times:
    if what == "searches":
        return measure_searches(folder)
    if what in SET_UP:
        return measure_set_up(what, folder)
    return measure_evaluation(what, folder)


def measure_evaluation(row: str, folder: str) -> Times:
    surface = limitsurf.LimitSurface(mesh(row, folder))
    times = {}
    for order in ORDERS:
        face, uv = saved(folder, row, f"{order}.face"), saved(folder, row, f"{order}.uv")
        for derivatives, result in enumerate(RESULTS):
            call = partial(surface.evaluate, face, uv, derivatives, threads=1)
            times[f"{row}, {order}: {result}"] = 1e9 * seconds(call) / len(face)
    return times


def measure_set_up(what: str, folder: str) -> Times:
    times = {}
    for row in OPENED:
        control_mesh = mesh(row, folder)
        surface = limitsurf.LimitSurface(control_mesh)
        if what == "open":
            # the control mesh is a part of it, as in C++
            call = partial(open_mesh, row, folder)
        elif row == "mixed-20k-faces":
            continue
        else:
            call = partial(surface.set_positions, np.array(control_mesh.positions), threads=1)
        times[f"{SET_UP[what]}, {row}"] = 1e9 * seconds(call) / surface.face_count
    return times


def measure_searches(folder: str) -> Times:
    surface = limitsurf.LimitSurface(mesh("closest-far", folder))
    times = {}
    for name in SEARCHED:
        origins, directions = (saved(folder, name, part) for part in ("origins", "directions"))
        if len(directions):
            call = partial(surface.ray_cast, origins, directions)
        else:
            call = partial(surface.closest, origins)
        times[name] = 1e9 * seconds(call, 3) / len(origins)
    return times


def open_mesh(row: str, folder: str) -> limitsurf.LimitSurface:
    return limitsurf.LimitSurface(mesh(row, folder))


def mesh(row: str, folder: str) -> limitsurf.ControlMesh:
    parts = (saved(folder, row, part) for part in ("positions", "face_sizes", "face_vertices"))
    return limitsurf.ControlMesh(*parts, boundary="smooth")


_saved: dict[str, np.ndarray] = {}


def saved(folder: str, row: str, part: str) -> np.ndarray:
    path = f"{folder}/{row}.{part}.npy"
    if path not in _saved:
        _saved[path] = np.load(path)
    return _saved[path]


def seconds(call: Callable[[], object], repeats: int = REPEATS) -> float:
    """Returns the median of the CPU time of all threads. Short calls are repeated more often: the
    first ones take longer.
    """
    call()
    found: list[float] = []
    while len(found) < repeats or sum(found) < LEAST_SECONDS:
        begin = time.process_time()
        call()
        found.append(time.process_time() - begin)
    return median(found)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--measure"]:
        print(json.dumps(measure(*sys.argv[2:])))
    else:
        main(sys.argv[1:])
