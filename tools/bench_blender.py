# SPDX-License-Identifier: Apache-2.0
"""Nearest points and rays in Blender: the limit surface is compared with
`mathutils.bvhtree.BVHTree`, which searches the polygons that Blender shows. Prints a table in
Markdown with the times and the errors of each.

    .venv/bin/python tools/bench_blender.py

BVHTree takes one point or ray at a time, so its times include a loop in Python, as in any script
that uses it. The limit surface takes one call with an array.
"""

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy
import limitsurf
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "addon"), str(ROOT / "docs")]

import bench_blender_truth as truth  # noqa: E402
from limit_surface.reading import cage  # noqa: E402
from mathutils.bvhtree import BVHTree  # noqa: E402

#: The viewport level of a new modifier, and that of a fine mesh
TREE_LEVELS = (1, 4)
#: The number of queries whose exact answers are found by brute force
CHECKED = 500
REPEATS = 3
#: The number of other objects in a large file
OTHER_OBJECTS = 3000


@dataclass
class Row:
    what: str
    set_up: float  # seconds
    nearest: float  # queries per second
    nearest_errors: "Errors"
    rays: float  # queries per second
    ray_errors: "Errors"


@dataclass
class Errors:
    """The errors relative to the diagonal of the mesh."""

    largest: float  # the error of the distance
    rms: float
    position: float  # the largest error
    missed: int

    def __str__(self) -> str:
        missed = f"; {self.missed} missed" if self.missed else ""
        return f"{self.largest:.1e} | {self.rms:.1e} | {self.position:.1e}{missed}"


class Bench:
    def __init__(self, side: int, queries: int, tree_queries: int) -> None:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        self.ob = truth.add_sheet(side)
        self.cage = cage.read(self.ob, bpy.context.evaluated_depsgraph_get())
        self.surface = limitsurf.LimitSurface(self.cage.mesh)
        self.diagonal = np.linalg.norm(np.ptp(self.cage.mesh.positions, axis=0))
        self.points = truth.points_nearby(self.surface, queries)
        self.rays = truth.rays(self.surface, queries)
        self.tree_queries = tree_queries
        finest = BVHTree.FromObject(self.ob, self._shown(4))
        self.nearest = truth.nearest(
            self.surface, self.cage.face_sizes, finest, self.points[:CHECKED]
        )

    def _shown(self, levels: int) -> bpy.types.Depsgraph:
        self.ob.modifiers[0].levels = levels
        depsgraph = bpy.context.evaluated_depsgraph_get()
        depsgraph.update()
        return depsgraph

    def reading(self, others: int) -> float:
        """Returns the seconds that reading the cage takes in a file with so many other objects."""
        for _ in range(others):
            thing = bpy.data.objects.new("Thing", None)
            bpy.context.scene.collection.objects.link(thing)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        return timed(lambda: cage.read(self.ob, depsgraph))[1]

    def limit_surface(self, threads: int) -> Row:
        clock = time.process_time if threads == 1 else time.perf_counter
        surface, set_up = timed(self._searched, clock)
        nearest, nearest_time = timed(lambda: surface.closest(self.points, threads=threads), clock)
        hits, ray_time = timed(
            lambda: surface.ray_cast(self.rays.origin, self.rays.direction, threads=threads), clock
        )
        count = len(self.points)
        return Row(
            f"limit surface, {'one core' if threads == 1 else 'all cores'}",
            set_up,
            count / nearest_time,
            self._nearest_errors(nearest.position, nearest.distance),
            count / ray_time,
            self._ray_errors(hits.position, hits.distance),
        )

    def _searched(self) -> limitsurf.LimitSurface:
        """Returns a surface whose search structure is built."""
        surface = limitsurf.LimitSurface(self.cage.mesh)
        surface.closest(self.points[:1])
        return surface

    def tree(self, levels: int) -> Row:
        depsgraph = self._shown(levels)
        tree, set_up = timed(lambda: BVHTree.FromObject(self.ob, depsgraph))
        count = self.tree_queries
        points = self.points[:count].tolist()
        found, nearest_time = timed(lambda: [tree.find_nearest(point) for point in points])
        pairs = list(
            zip(
                self.rays.origin[:count].tolist(), self.rays.direction[:count].tolist(), strict=True
            )
        )
        hits, ray_time = timed(lambda: [tree.ray_cast(*ray) for ray in pairs])
        return Row(
            f"BVHTree, level {levels}",
            set_up,
            count / nearest_time,
            self._nearest_errors(*_positions_and_distances(found)),
            count / ray_time,
            self._ray_errors(*_positions_and_distances(hits)),
        )

    def _nearest_errors(self, position: np.ndarray, distance: np.ndarray) -> Errors:
        points = self.points[:CHECKED]
        right = np.linalg.norm(self.nearest - points, axis=1)
        return self._errors(position[:CHECKED], distance[:CHECKED], self.nearest, right)

    def _ray_errors(self, position: np.ndarray, distance: np.ndarray) -> Errors:
        count = len(position)
        hit = self.rays.hit[:count]
        right = np.linalg.norm(hit - self.rays.origin[:count], axis=1)
        return self._errors(position, distance, hit, right)

    def _errors(
        self,
        position: np.ndarray,
        distance: np.ndarray,
        right_position: np.ndarray,
        right_distance: np.ndarray,
    ) -> Errors:
        found = np.isfinite(distance)
        off = np.abs(distance - right_distance)[found] / self.diagonal
        moved = np.linalg.norm(position - right_position, axis=1)[found] / self.diagonal
        return Errors(off.max(), np.sqrt(np.mean(off**2)), moved.max(), int((~found).sum()))


def _positions_and_distances(found: list[tuple]) -> tuple[np.ndarray, np.ndarray]:
    """Returns NaN where nothing was found."""
    position = [hit[0][:] if hit[0] else (np.nan,) * 3 for hit in found]
    return np.array(position), np.array([np.nan if hit[3] is None else hit[3] for hit in found])


def timed(work: Callable[[], object], clock: Callable[[], float] = time.process_time) -> tuple:
    """Returns the result, and the shortest of some times: seconds of one core, which do not depend
    on other programs on the machine, or the seconds of another clock.
    """
    times = []
    for _ in range(REPEATS):
        begin = clock()
        result = work()
        times.append(clock() - begin)
    return result, min(times)


def table(rows: list[Row]) -> str:
    lines = []
    for title, speed, errors in (
        ("nearest points", "nearest", "nearest_errors"),
        ("rays", "rays", "ray_errors"),
    ):
        lines += [
            f"| {title} | set-up | a second | distance: max | RMS | position: max |",
            "|---|---:|---:|---:|---:|---:|",
        ]
        lines += [
            f"| {row.what} | {row.set_up:.3f} s | {getattr(row, speed):,.0f} "
            f"| {getattr(row, errors)} |"
            for row in rows
        ]
        lines.append("")
    return "\n".join(lines)


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--faces", type=int, default=10_000, help="approximate number of the mesh's faces"
    )
    parser.add_argument(
        "--queries", type=int, default=200_000, help="number of queries of the limit surface"
    )
    parser.add_argument(
        "--tree-queries", type=int, default=50_000, help="number of queries of each BVHTree"
    )
    options = parser.parse_args(arguments)
    bench = Bench(round(options.faces**0.5), options.queries, options.tree_queries)
    print(
        f"Blender {bpy.app.version_string}, {len(bench.cage.face_sizes):,} faces; "
        f"{options.queries:,} queries, {options.tree_queries:,} of each BVHTree; the best of "
        f"{REPEATS} times; errors relative to the diagonal\n"
    )
    rows = [bench.limit_surface(threads) for threads in (1, 0)]
    rows += [bench.tree(levels) for levels in TREE_LEVELS]
    print(table(rows))
    for others in (0, OTHER_OBJECTS):
        seconds = bench.reading(others)
        print(f"The cage is read in {1e3 * seconds:.1f} ms among {others:,} other objects")


if __name__ == "__main__":
    main(sys.argv[1:])
