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
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "docs")]

import bench_python  # noqa: E402
import bench_threads  # noqa: E402
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
    "interpolation": Run("### Beside Embree's interpolation", (("--interpolate",),)),
}
#: The numbers of samples on a face whose times are drawn
PER_FACE = (1, 2, 5, 10, 30, 100, 300)
OPENING = "### Opening a mesh, ns per face"
#: The sides of the grids whose opening is drawn, and what of it
OPENED_SIDES = (100, 200, 500, 1000, 1500)
OPENED = (
    "limitsurf ControlMesh + LimitSurface",
    "Far topology alone",
    "Far topology + Bfr 2 surfaces",
    "Far topology + Bfr 10 surfaces",
    "Far adaptive refinement, level 6",
)


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


def with_image(page: str, heading: str, image: str, what: str) -> str:
    """Returns the page with an image at the end of a section, unless it has that image already."""
    line = f"![{what}](images/{image}.png)\n"
    if line in page:
        return page
    _, end = section(page, heading)
    return page[:end].rstrip("\n") + f"\n\n{line}" + page[end:]


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


def draw_opening() -> None:
    """Draws the time in which a mesh is opened against the number of its faces."""
    seconds: dict[str, list[float]] = {}
    faces = []
    for side in OPENED_SIDES:
        text = output((f"--large={side}",))
        faces.append(int(text.split(" quads", 1)[0].split()[-1]))
        for row in rows(tables(text)[0]):
            seconds.setdefault(row[""], []).append(float(row["CPU s"]))
    figure, plot = plt.subplots(figsize=(7, 4), layout="constrained")
    for name in OPENED:
        plot.plot(faces, 1e9 * np.array(seconds[name]) / faces, marker="o", label=name)
    plot.set(xlabel="faces", ylabel="ns a face, all threads together", xscale="log", ylim=0)
    plot.legend(bbox_to_anchor=(0.5, 1), loc="lower center")
    save(figure, IMAGES / "benchmark_opening.png")


def draw_threads(found: dict[str, dict[int, float]]) -> None:
    """Draws the time of calls against the number of threads, over that on one."""
    figure, plot = plt.subplots(figsize=(7, 4.5), layout="constrained")
    for name in bench_threads.DRAWN:
        seconds = found[name]
        threads = sorted(seconds)
        shares = [seconds[count] / seconds[1] for count in threads]
        plot.plot(threads, shares, marker="o", label=name)
    most = max(max(seconds) for seconds in found.values())
    ideal = np.arange(1, most + 1)
    plot.plot(ideal, 1 / ideal, color="black", linestyle=":", label="1 over the threads")
    plot.set(xlabel="threads", ylabel="wall time over that on one thread", ylim=0)
    plot.set_xticks(ideal)
    plot.legend(fontsize="small", loc="lower left")
    save(figure, IMAGES / "benchmark_threads.png")


def machine() -> str:
    cpu = platform.processor() or platform.machine()
    about = dict(
        line.split(":", 1) for line in Path("/proc/cpuinfo").read_text().splitlines() if line
    )
    known = {name.strip(): value.strip() for name, value in about.items()}
    if "model name" in known:
        # The name of a virtual machine's processor may be that of many generations.
        flags = known["flags"].split()
        vectors = "AVX-512" if "avx512f" in flags else "AVX2" if "avx2" in flags else "no AVX2"
        cpu = f"{known['model name']} (family {known['cpu family']}, {vectors})"
    compiler = subprocess.run(["c++", "--version"], stdout=subprocess.PIPE, text=True, check=True)
    return (
        f"The results are for limitsurf {limitsurf.__version__}, "
        f"{compiler.stdout.splitlines()[0]} with `-O3`, on {os.cpu_count()} cores of "
        f"{cpu} ({time.strftime('%Y-%m-%d')})."
    )


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    names = [*RUNS, "batches", "opening", "python"]
    parser.add_argument("--only", nargs="+", choices=names, help="what to run; default: all")
    wanted = parser.parse_args(arguments).only or names
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
    if "opening" in wanted:
        draw_opening()
        what = "Time for opening a mesh against the number of its faces"
        page = with_image(page, OPENING, "benchmark_opening", what)
    if "python" in wanted:
        found = bench_threads.measured()
        beside = bench_python.lines(bench_python.ROWS, bench_python.SAMPLES, ("P,D1",))
        made = [bench_threads.table(found), "".join(f"{line}\n" for line in beside)]
        page = replaced(page, "### From Python", made)
        draw_threads(found)
        what = "Time of calls against the number of threads"
        page = with_image(page, "### From Python", "benchmark_threads", what)
    PAGE.write_text(page)


if __name__ == "__main__":
    main(sys.argv[1:])
