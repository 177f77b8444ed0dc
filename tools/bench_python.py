# SPDX-License-Identifier: Apache-2.0
"""Compares calls of the Python module with the same calls in C++: the rows of the table of
evaluation, on the same meshes, at the same locations, with results in newly allocated memory.
(Python's calls compute normals together with derivatives; those in C++ do not.) Prints a table in
Markdown, with ns of CPU time a sample.

    .venv/bin/python tools/bench_python.py [ROW ...] [--samples N ...]

With names of rows ("regular", "n-gon"), only those. C++ and Python take turns in processes of their
own, and each number is the least of some turns. Build `limitsurf_bench` before; the machine should
have nothing else to do.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median

import limitsurf
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
BENCH = ROOT / "build/cpp/native/bench/limitsurf_bench"
ROWS = (
    "regular",
    "interior-EV",
    "boundary-EV",
    "corner",
    "multi-EV",
    "n-gon",
    "near-interior-EV",
    "near-boundary-EV",
    "near-corner",
    "mixed-20k-faces",
)
ORDERS = ("sorted", "random")
RESULTS = ("P", "P,D1", "P,D1,D2")  # their place is the order of the derivatives
SAMPLES = (100_000, 1_000_000)
TURNS = 3
REPEATS = 9
# The allocator returns all freed memory to the system. Otherwise it keeps some, after a while.
FRESH = {"MALLOC_MMAP_THRESHOLD_": "131072", "MALLOC_TRIM_THRESHOLD_": "131072"}

#: Nanoseconds a sample by order and result
Times = dict[tuple[str, str], float]


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("rows", nargs="*", metavar="ROW", help=f"of {', '.join(ROWS)}")
    parser.add_argument("--samples", nargs="+", type=int, default=SAMPLES, metavar="N")
    options = parser.parse_args(arguments)
    for line in lines(options.rows or ROWS, options.samples, RESULTS):
        print(line, flush=True)


def lines(rows: Sequence[str], samples: Sequence[int], results: Sequence[str]) -> Iterator[str]:
    """Yields the lines of the table."""
    yield "| face | samples | order | result | C++ | Python | Python / C++ |"
    yield "|---|---:|---|---|---:|---:|---:|"
    for count in samples:
        with tempfile.TemporaryDirectory() as folder:
            output(BENCH, f"--save={folder}", f"--samples={count}")
            for row in rows:
                for line, result in compared(row, count, folder):
                    if result in results:
                        yield line


def compared(row: str, samples: int, folder: str) -> Iterator[tuple[str, str]]:
    """Yields the lines of one row of faces, and the results that they are about."""
    turns = [(cpp_times(row, samples), python_times(row, folder)) for _ in range(TURNS)]
    for order, result in turns[0][0]:
        cpp, python = (min(turn[i][order, result] for turn in turns) for i in (0, 1))
        line = (
            f"| {row} | {samples:,} | {order} | {result} | {cpp:.1f} | {python:.1f} "
            f"| {python / cpp:.2f} |"
        )
        yield line, result


def cpp_times(row: str, samples: int) -> Times:
    text = output(
        BENCH,
        "--fresh-memory",
        f"--samples={samples}",
        f"--benchmark_filter=evaluate/{row}/.*/limitsurf",
    )
    times = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if cells[:1] == [row]:
            times[cells[1], cells[2]] = float(cells[3])
    return times


def python_times(row: str, folder: str) -> Times:
    text = output(sys.executable, __file__, "--measure", row, folder)
    return {(order, result): ns for order, result, ns in json.loads(text)}


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


def measure(row: str, folder: str) -> None:
    """Prints order, result and nanoseconds a sample, as JSON, of one row of faces."""

    def saved(name: str) -> np.ndarray:
        return np.load(f"{folder}/{row}.{name}.npy")

    mesh = limitsurf.ControlMesh(
        saved("positions"), saved("face_sizes"), saved("face_vertices"), boundary="smooth"
    )
    surface = limitsurf.LimitSurface(mesh)
    measured = []
    for order in ORDERS:
        face, uv = saved(f"{order}.face"), saved(f"{order}.uv")
        for derivatives, result in enumerate(RESULTS):
            seconds = []
            for _ in range(REPEATS):
                begin = time.process_time()
                surface.evaluate(face, uv, derivatives, threads=1)
                seconds.append(time.process_time() - begin)
            measured.append((order, result, 1e9 * median(seconds) / len(face)))
    print(json.dumps(measured))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--measure"]:
        measure(*sys.argv[2:])
    else:
        main(sys.argv[1:])
