# SPDX-License-Identifier: Apache-2.0
"""Runs the benchmarks of the library beside its peers, and writes their tables and plots into
docs/benchmarks.md. Everything else on that page stays as it is; read it again afterwards.

    .venv/bin/python tools/bench_report.py [--only evaluation queries ...]

A table of the page is replaced by the one with the same columns that the benchmarks print, section
by section. Build `limitsurf_bench` before; the machine should have nothing else to do. All of it
takes about half an hour.
"""

import argparse
import os
import platform
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "docs")]

import limitsurf  # noqa: E402
from figures.plots import plt, save  # noqa: E402

BENCH = ROOT / "build/cpp/native/bench/limitsurf_bench"
PAGE = ROOT / "docs/benchmarks.md"
IMAGES = ROOT / "docs/images"


@dataclass(frozen=True)
class Run:
    """Calls of limitsurf_bench, whose tables stand below one heading of the page."""

    heading: str
    calls: tuple[tuple[str, ...], ...]


RUNS = {
    "evaluation": Run("## Results", ((),)),
    "million": Run("### A million quads", (("--large",),)),
    "semi-sharp": Run("### Every edge semi-sharp", (("--semi-sharp=100",), ("--semi-sharp=200",))),
    "queries": Run("### Queries", (("--queries",),)),
}
#: The numbers of samples on a face whose times are drawn
PER_FACE = (1, 2, 5, 10, 30, 100, 300)


def output(options: tuple[str, ...]) -> str:
    print("limitsurf_bench", *options, flush=True)
    run = subprocess.run([BENCH, *options], stdout=subprocess.PIPE, text=True, check=True)
    return run.stdout


def tables(text: str) -> list[str]:
    """Returns the tables in Markdown that a text contains."""
    return re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE)


def header(table: str) -> str:
    return table.split("\n", 1)[0]


def section(page: str, heading: str) -> tuple[int, int]:
    """Returns where a section begins and ends: at the next heading of its level or above."""
    begin = page.index(f"\n{heading}\n") + 1
    level = heading.index(" ")
    following = re.search(rf"\n#{{1,{level}}} ", page[begin + level :])
    return begin, begin + level + following.start() if following else len(page)


def replaced(page: str, heading: str, made: list[str]) -> str:
    """Returns the page with the tables of a section replaced. The first of several tables with the
    same columns replaces the first one there, and so on.
    """
    begin, end = section(page, heading)
    text = page[begin:end]
    seen: dict[str, int] = {}
    for table in made:
        columns = header(table)
        old = [found for found in tables(text) if header(found) == columns]
        place = seen.setdefault(columns, 0)
        seen[columns] += 1
        if place >= len(old):
            raise ValueError(f"{heading} has no table for {columns}")
        text = text.replace(old[place], table, 1)
    return page[:begin] + text + page[end:]


def rows(table: str) -> Iterator[dict[str, str]]:
    """Returns the rows of a table, by the names of the columns."""
    lines = [[cell.strip() for cell in line.split("|")[1:-1]] for line in table.splitlines()]
    for line in lines[2:]:
        yield dict(zip(lines[0], line, strict=True))


def draw_depth(page: str) -> None:
    """Draws the time of a sample against its distance from an extraordinary vertex."""
    (table,) = (table for table in tables(page) if header(table).startswith("| face | distance"))
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True, layout="constrained")
    for plot, result in zip(axes, ("P,D1", "P,D1,D2"), strict=True):
        found = [r for r in rows(table) if (r["face"], r["result"]) == ("boundary-EV", result)]
        depth = [int(row["distance"].removeprefix("2^-")) for row in found]
        for library in ("limitsurf", "Bfr 2", "Bfr 10"):
            plot.plot(depth, [float(row[library]) for row in found], marker="o", label=library)
        plot.set(title=result, xlabel="n, at 2^-n of a face from the vertex")
    axes[0].set(ylabel="ns a sample", ylim=0)
    axes[0].legend()
    save(figure, IMAGES / "benchmark_depth.png")


def draw_batches() -> None:
    """Draws the time of a sample, over Bfr's in the same run, against the number of samples on each
    face.
    """
    wanted = "evaluate/(regular|boundary-EV|multi-EV)/sorted/P,D1/(limitsurf|Bfr 2)"
    faces = {"regular": 1140, "boundary-EV": 30, "multi-EV": 500}
    ratios: dict[str, list[float]] = {name: [] for name in faces}
    for count in PER_FACE:
        for name, number in faces.items():
            text = output(
                (
                    f"--samples={count * number}",
                    f"--benchmark_filter={wanted.replace('regular|boundary-EV|multi-EV', name)}",
                )
            )
            (row,) = rows(tables(text)[0])
            ratios[name].append(float(row["limitsurf"]) / float(row["Bfr 2"]))
    figure, plot = plt.subplots(figsize=(7, 4), layout="constrained")
    for name, values in ratios.items():
        plot.plot(PER_FACE, values, marker="o", label=name)
    plot.set(xlabel="samples on each face", ylabel="time over that of Bfr 2", xscale="log", ylim=0)
    plot.legend()
    save(figure, IMAGES / "benchmark_batch.png")


def best(call: Callable[[int], object], threads: int, repeats: int = 5) -> float:
    """Returns the least of some wall times of a call on so many threads, in seconds."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        call(threads)
        times.append(time.perf_counter() - begin)
    return min(times)


def python_table() -> str:
    """Returns the times of calls of the Python module on one thread and on all of them."""
    side = 100
    y, x = np.mgrid[: side + 1, : side + 1].astype(float)
    z = 8 * np.sin(9 * x / side) * np.cos(7 * y / side)
    first = (y[:-1, :-1] * (side + 1) + x[:-1, :-1]).astype(int).ravel()
    faces = np.stack([first, first + 1, first + side + 2, first + side + 1], 1)
    mesh = limitsurf.ControlMesh.from_faces(np.stack([x, y, z], -1).reshape(-1, 3), faces)
    surface = limitsurf.LimitSurface(mesh)
    rng, count = np.random.default_rng(1), 1_000_000
    face, uv = np.sort(rng.integers(0, len(faces), count)), rng.random((count, 2))
    near = surface.evaluate(face, uv).position + rng.normal(scale=0.1, size=(count, 3))
    shuffled = rng.permutation(count)
    random_face, random_uv = face[shuffled], uv[shuffled]
    origins = near[shuffled] + [0, 0, 100]
    down = np.tile([0.0, 0, -1], (count, 1))
    calls: dict[str, Callable[[int], object]] = {
        "evaluate, P": lambda threads: surface.evaluate(face, uv, threads=threads),
        "evaluate, P with du, dv and normals": lambda threads: surface.evaluate(
            face, uv, 1, threads=threads
        ),
        "the same in float32": lambda threads: surface.evaluate(
            face, uv, 1, threads=threads, dtype=np.float32
        ),
        "P with du, dv and normals, faces in random order": lambda threads: surface.evaluate(
            random_face, random_uv, 1, threads=threads
        ),
        "evaluate, second derivatives too": lambda threads: surface.evaluate(
            face, uv, 2, threads=threads
        ),
        "frames": lambda threads: surface.frames(face, uv, threads=threads),
        "closest, within a tenth of an edge": lambda threads: surface.closest(
            near, threads=threads
        ),
        "ray_cast, from above": lambda threads: surface.ray_cast(origins, down, threads=threads),
        "scatter_uniform": lambda threads: surface.scatter_uniform(count, seed=1, threads=threads),
    }
    lines = ["| Python | one thread | all threads | ratio |", "|---|---:|---:|---:|"]
    for name, call in calls.items():
        print(name, flush=True)
        one, all_cores = (1e9 / count * best(call, threads) for threads in (1, 0))
        lines.append(f"| {name} | {one:.3g} | {all_cores:.3g} | {one / all_cores:.2f} |")
    return "\n".join([*lines, ""])


def machine() -> str:
    cpu = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            cpu = line.split(":", 1)[1].strip()
            break
    compiler = subprocess.run(["c++", "--version"], stdout=subprocess.PIPE, text=True, check=True)
    return (
        f"The results are for limitsurf {limitsurf.__version__}, "
        f"{compiler.stdout.splitlines()[0]} with `-O3`, on {os.cpu_count()} cores of "
        f"{cpu} ({time.strftime('%Y-%m-%d')})."
    )


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--only", nargs="+", choices=[*RUNS, "batches", "python"], help="what to run; default: all"
    )
    wanted = parser.parse_args(arguments).only or [*RUNS, "batches", "python"]
    page = PAGE.read_text()
    for name, run in RUNS.items():
        if name in wanted:
            made = [table for options in run.calls for table in tables(output(options))]
            page = replaced(page, run.heading, made)
            if name == "evaluation":
                draw_depth(page)
                page = re.sub(r"^The results are for limitsurf .*$", machine(), page, flags=re.M)
    if "batches" in wanted:
        draw_batches()
    if "python" in wanted:
        page = replaced(page, "### From Python", [python_table()])
    PAGE.write_text(page)


if __name__ == "__main__":
    main(sys.argv[1:])
