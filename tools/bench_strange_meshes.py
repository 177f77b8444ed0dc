#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what strange meshes cost: folds, poles, triangles, large polygons, stacks of sheets.

    .venv/bin/python tools/bench_strange_meshes.py [NAME ...]

Prints a table in Markdown. Beside each call stands the same call on a usual mesh of quads, measured
in the same run, where there is one, and the limit that the call should keep. Times are processor
time of all threads, the best of some repetitions. With names, only the rows whose name contains one
of them.
"""

import sys
import time
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any

import limitsurf as ls
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "native/python/tests"))

import shapes  # noqa: E402

POINTS = 4_000  # of a search
SPREAD, FEW = 20_000, 2_000  # of blue noise
MOST_SECONDS = 3.0  # after which a call is not repeated


def wavy(columns: int, rows: int) -> tuple[Any, Any]:
    """A sheet with two waves each way and a little noise; its longest side is 1."""
    positions, faces = shapes.grid(columns, rows)
    positions[:, :2] /= max(columns, rows)
    rng = np.random.default_rng(0)
    positions[:, 2] = 0.08 * np.sin(9 * positions[:, 0]) * np.cos(7 * positions[:, 1])
    return positions + rng.normal(0, 0.1 / max(columns, rows), positions.shape), faces


def in_triangles(positions: Any, quads: Any) -> tuple[Any, Any]:
    return positions, shapes.halves(quads)


def polygon(corners: int) -> tuple[Any, list[list[int]]]:
    """One bent face of so many corners."""
    at = 2 * np.pi * np.arange(corners) / corners
    ring = np.stack([np.cos(at), np.sin(at), 0.1 * np.sin(3 * at)], axis=1)
    return ring, [list(range(corners))]


def bowl(faces: int) -> tuple[Any, Any]:
    """A pole whose rings lie at different heights."""
    positions, triangles = shapes.pole(faces)
    positions = positions * 1.0
    positions[:, 2] += 0.3 * np.hypot(positions[:, 0], positions[:, 1])
    return positions, triangles


def stack(sheets: int) -> tuple[Any, Any]:
    positions, faces = wavy(20, 20)
    offsets = len(positions) * np.arange(sheets)
    return np.tile(positions, (sheets, 1)), (faces[None] + offsets[:, None, None]).reshape(-1, 4)


def stage() -> tuple[Any, Any]:
    """A U of planar quads, all in one plane."""
    positions, faces = shapes.grid(58, 3)
    turn = np.pi * positions[:, 0] / 58
    radius = 1 + 0.3 * positions[:, 1]
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), 0 * turn], axis=1), faces


def folded() -> tuple[Any, Any]:
    """A grid in a plane whose vertices lie at random places: it folds over itself."""
    positions, faces = shapes.grid(30, 30)
    positions[:, :2] += np.random.default_rng(3).uniform(-1, 1, (len(positions), 2))
    return positions, faces


def cube(size: float) -> tuple[Any, Any]:
    positions, faces = shapes.cube()
    return positions * size, faces


def stretched(mesh: tuple[Any, Any]) -> tuple[Any, Any]:
    positions, faces = mesh
    return positions * [1e6, 1, 1], faces


OBLIQUE = (np.outer([0, 1, 1.37, 0.37], [0.3, 0.7, 0.11]), [[0, 1, 2, 3]])

MESHES: dict[str, Callable[[], tuple[Any, Any]]] = {
    "quads": lambda: wavy(100, 100),
    "triangles": lambda: in_triangles(*wavy(70, 70)),
    "a pole of 64": lambda: bowl(64),
    "a pole of 512": lambda: bowl(512),
    "a pole of 32,000": lambda: bowl(32_000),
    "a polygon of 1,000": lambda: polygon(1000),
    "a quad that is collapsed onto an oblique line": lambda: OBLIQUE,
    "a cube of size 1e78": lambda: cube(1e78),
    "a cube of size 1e-77": lambda: cube(1e-77),
    "a cube": lambda: cube(1.0),
    "a grid that folds over itself in a plane": folded,
    "a U of 174 planar quads": stage,
    "20 coincident sheets": lambda: stack(20),
    "one of these sheets": lambda: stack(1),
    "flat quads": lambda: shapes.grid(100, 100),
    "flat quads, stretched by 1e6": lambda: stretched(shapes.grid(100, 100)),
    "quads, stretched by 1e6": lambda: stretched(wavy(100, 100)),
}
FOLDED = (
    "a quad that is collapsed onto an oblique line",
    "a cube",
    "a cube of size 1e78",
    "a cube of size 1e-77",
    "a grid that folds over itself in a plane",
    "a U of 174 planar quads",
)


@cache
def surface(name: str) -> ls.LimitSurface:
    return ls.LimitSurface(ls.ControlMesh.from_faces(*MESHES[name]()))


def seconds(call: Callable[[], object], best_of: int = 3) -> float:
    best = np.inf
    for _ in range(best_of):
        start = time.process_time()
        call()
        best = min(best, time.process_time() - start)
        if best > MOST_SECONDS:
            break
    return best


@cache
def area(name: str) -> float:
    made = surface(name)
    return seconds(made.area)


@cache
def blue_noise(name: str, count: int = SPREAD) -> float:
    made = surface(name)
    return seconds(lambda: made.scatter_blue_noise(count=count))


@cache
def near_points(name: str) -> Any:
    """Random points within 5 % of the diagonal of the surface."""
    made, rng = surface(name), np.random.default_rng(1)
    face = rng.integers(0, made.face_count, POINTS)
    on = made.evaluate(face, rng.random((POINTS, 2))).position
    diagonal = np.linalg.norm(np.ptp(MESHES[name]()[0], axis=0))
    return on + rng.normal(0, 0.02 * diagonal, on.shape)


@cache
def closest(name: str, place: str = "near") -> float:
    """Of one point."""
    made = surface(name)
    points = near_points(name)
    if place == "axis":
        points = np.zeros((POINTS, 3))
        points[:, 2] = np.random.default_rng(2).uniform(-0.5, 0.5, POINTS)
    elif place == "far":
        points = 1e8 * points / np.linalg.norm(points, axis=1)[:, None]
    made.closest(points[:1])
    return seconds(lambda: made.closest(points)) / len(points)


@cache
def closest_facing(name: str, direction: float, max_angle: float) -> float:
    """Of one point."""
    made, points, facing = surface(name), near_points(name), [0, 0, direction]
    made.closest(points[:1], facing=facing)
    return seconds(lambda: made.closest(points, facing=facing, max_angle=max_angle)) / len(points)


@cache
def opening(name: str) -> float:
    mesh = ls.ControlMesh.from_faces(*MESHES[name]())
    return seconds(lambda: ls.LimitSurface(mesh))


@cache
def posing(name: str) -> float:
    made, positions = surface(name), MESHES[name]()[0]
    return seconds(lambda: made.set_positions(positions))


Measure = Callable[[], float]
Row = tuple[str, Measure, Measure | None, str]  # name, call, the usual call, limit


def rows() -> Iterator[Row]:
    yield "area, 10,000 quads", partial(area, "quads"), None, "0.6 s"
    for name in FOLDED:
        yield f"area, {name}", partial(area, name), None, "0.1 s"
    yield "area, 9,800 triangles", partial(area, "triangles"), partial(area, "quads"), "3 x"
    usual = partial(blue_noise, "quads")
    for name in ("triangles", "a pole of 64", "a pole of 512", "a polygon of 1,000"):
        yield f"blue noise of {SPREAD:,}, {name}", partial(blue_noise, name), usual, "3 x"
    usual = partial(closest, "quads")
    for name in ("triangles", "a pole of 64", "a pole of 512", "a polygon of 1,000"):
        yield f"closest, {name}", partial(closest, name), usual, "3 x"
    name = "a pole of 32,000"
    for place in ("axis", "near"):
        text = "on the axis" if place == "axis" else "near the surface"
        yield f"closest {text}, {name}", partial(closest, name, place), usual, "20 us"
    yield f"opening, {name}", partial(opening, name), None, "2 s"
    yield f"new positions, {name}", partial(posing, name), None, "0.2 s"
    for name in ("flat quads", "quads", "triangles"):
        for angle in (1.57, 0.5):
            match = partial(closest_facing, name, 1, angle)
            none = partial(closest_facing, name, -1, angle)
            yield f"closest that faces within {angle}, {name}", match, usual, "10 x"
            yield f"closest where nothing faces within {angle}, {name}", none, match, "10 x"
    name = "20 coincident sheets"
    usual = partial(closest, "one of these sheets")
    yield f"closest, {name}", partial(closest, name), usual, "1 ms"
    for name in ("flat quads, stretched by 1e6", "quads, stretched by 1e6"):
        usual = partial(blue_noise, "quads", FEW)
        yield f"blue noise of {FEW:,}, {name}", partial(blue_noise, name, FEW), usual, "1 s"
    yield "closest from 1e8 away, a cube", partial(closest, "a cube", "far"), None, "20 us"


def text_of(time_taken: float) -> str:
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if time_taken >= size:
            return f"{time_taken / size:.3g} {unit}"
    return f"{time_taken * 1e9:.3g} ns"


def main() -> None:
    names = sys.argv[1:]
    print("| | processor time | of the usual mesh | ratio | limit |\n|---|---|---|---|---|")
    for name, measure, compare, limit in rows():
        if names and not any(part in name for part in names):
            continue
        taken = measure()
        beside = ["", ""]
        if compare:
            usual = compare()
            beside = [text_of(usual), f"{taken / usual:.2g}"]
        print(f"| {name} | {text_of(taken)} | {beside[0]} | {beside[1]} | {limit} |", flush=True)


if __name__ == "__main__":
    main()
