# SPDX-License-Identifier: Apache-2.0
"""Measures how long calls of the module `limitsurf` are deaf to Ctrl-C, how soon it ends them, and
how long they keep other Python threads waiting. Prints a table in Markdown.

    .venv/bin/python tools/bench_interrupts.py [NAME ...]

With names, only the calls whose name contains one of them. A timer signal arrives every few
milliseconds while a call runs, and Python counts when it hears it: the longest time without is the
longest that Ctrl-C can take to be heard. Then the call is made again and interrupted at some
moments.
"""

import argparse
import os
import pickle
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import limitsurf as ls
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "native/python/tests"))

import shapes  # noqa: E402

TICK = 0.005  # seconds between two signals
MOMENTS = (0.15, 0.5, 0.9)  # parts of a call after which Ctrl-C comes
LIMIT = 0.5  # seconds within which Ctrl-C is to be heard

Call = Callable[[], object]


@cache
def positions_and_faces(kind: str) -> tuple[Any, Any]:
    if kind == "quads":
        positions, faces = shapes.grid(1000, 1000)
    elif kind in ("triangles", "some triangles"):
        side = 200 if kind == "triangles" else 12
        positions, quads = shapes.grid(side, side)
        faces = shapes.halves(quads)
    elif kind == "sharp":
        positions, faces = shapes.grid(250, 250)
    elif kind == "pole":
        return shapes.pole(10_000)
    else:
        positions, faces = shapes.grid(300, 300)
    positions = positions * 1.0
    positions[:, 2] = np.sin(0.9 * positions[:, 0]) * np.sin(positions[:, 1])
    return positions, faces


def edges_of(faces: Any) -> Any:
    return np.vstack([faces[:, [0, 1]], faces[:, [0, 3]]])


@cache
def mesh(kind: str) -> ls.ControlMesh:
    positions, faces = positions_and_faces(kind)
    sharp = (edges_of(faces), np.full(2 * len(faces), 4.5)) if kind == "sharp" else None
    return ls.ControlMesh.from_faces(positions, faces, edge_sharpness=sharp)


@cache
def surface(kind: str) -> ls.LimitSurface:
    return ls.LimitSurface(mesh(kind))


@cache
def places(kind: str, count: int) -> tuple[Any, Any]:
    rng = np.random.default_rng(0)
    return rng.integers(0, surface(kind).face_count, count), rng.random((count, 2))


@cache
def uv_map(kind: str) -> ls.SurfaceData:
    positions = positions_and_faces(kind)[0][:, :2]
    return surface(kind).vertex_data(positions / positions.max())


def making() -> Iterator[tuple[str, Call]]:
    positions, faces = positions_and_faces("quads")
    sizes = np.full(len(faces), 4)
    edges = edges_of(faces)
    nested = positions_and_faces("middle")[1].tolist() * 4
    yield "ControlMesh, quads", lambda: ls.ControlMesh(positions, sizes, faces.ravel())
    yield (
        "ControlMesh, all edges sharp",
        lambda: ls.ControlMesh.from_faces(
            positions, faces, edge_sharpness=(edges, np.full(len(edges), 2.0))
        ),
    )
    yield (
        "ControlMesh.from_faces, lists",
        lambda: ls.ControlMesh.from_faces(positions_and_faces("middle")[0], nested),
    )
    for kind in ("quads", "triangles", "sharp", "pole"):
        yield f"LimitSurface, {kind}", lambda kind=kind: ls.LimitSurface(mesh(kind))
    stored = pickle.dumps(surface("triangles"))
    yield "pickle.loads(LimitSurface)", lambda: pickle.loads(stored)


def posing() -> Iterator[tuple[str, Call]]:
    for kind in ("quads", "triangles", "sharp", "pole"):
        positions = positions_and_faces(kind)[0]
        times = {"quads": 4, "pole": 4}.get(kind, 2)

        def pose(kind: str = kind, positions: Any = positions, times: int = times) -> None:
            for _ in range(times):
                surface(kind).set_positions(positions)

        yield f"set_positions, {kind}", pose
    values = np.random.default_rng(0).random((len(positions_and_faces("triangles")[0]), 12))
    corners = positions_and_faces("triangles")[1].ravel()
    triangles = surface("triangles")
    data = triangles.vertex_data(values)
    yield "set_values, 12 columns", lambda: data.set_values(values)
    yield "vertex_data, 12 columns", lambda: triangles.vertex_data(values)
    yield "varying", lambda: triangles.varying(values)
    yield "face_varying", lambda: triangles.face_varying(values, corners, "boundaries")


def evaluating() -> Iterator[tuple[str, Call]]:
    many = 4_000_000
    triangles = surface("triangles")
    yield "evaluate", lambda: triangles.evaluate(*places("triangles", many), derivatives=2)
    yield "frames", lambda: triangles.frames(*places("triangles", many))
    yield "curvature", lambda: triangles.curvature(*places("triangles", many))
    corners = triangles.vertex_locations()
    at_vertices = (corners.face, corners.uv)
    yield "curvature, average", lambda: triangles.curvature(*at_vertices, irregular="average")
    yield "stencils", lambda: triangles.stencils(*places("triangles", many // 8), derivatives=1)
    yield "tiles", lambda: triangles.tiles(*places("triangles", many // 64))
    yield "tile_quadtree", lambda: surface("middle").tile_quadtree()
    yield "tile_quadtree, triangles", lambda: surface("some triangles").tile_quadtree()
    unwrapped, fewer = uv_map("triangles"), places("triangles", many // 4)
    yield "bounds", lambda: triangles.bounds()
    yield "bounds of data", lambda: unwrapped.bounds(8)
    yield "tangent_frames", lambda: triangles.tangent_frames(unwrapped, *fewer)
    yield "tessellate", lambda: surface("middle").tessellate(3, corner_normals=True)
    yield "tessellate, gigabytes", lambda: surface("middle").tessellate(4)
    yield "levels_within", lambda: triangles.levels_within(1e-2)
    yield "levels_of_length", lambda: triangles.levels_of_length(1e-3)


def searching() -> Iterator[tuple[str, Call]]:
    rng = np.random.default_rng(0)
    near = rng.uniform(0, 300, (1_000_000, 3)) * [1, 1, 0.003]
    far = rng.uniform(-100, 400, (100_000, 3))
    thin = np.repeat(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])[None], 400, 0)
    stack = ls.LimitSurface(
        ls.ControlMesh.from_faces(thin.reshape(-1, 3), np.arange(1600).reshape(-1, 4))
    )
    yield "closest, first call", lambda: ls.LimitSurface(mesh("triangles")).closest(near[:100])
    yield "closest, near", lambda: surface("middle").closest(near)
    yield "closest, far", lambda: surface("middle").closest(far)
    yield "closest, coincident sheets", lambda: stack.closest(rng.random((20_000, 3)))
    yield "closest, none faces", lambda: surface("middle").closest(near[:50_000], facing=[0, 0, -1])
    yield "ray_cast", lambda: surface("middle").ray_cast(far * 5, near[:100_000] - far)
    yield "ray_cast_all", lambda: surface("middle").ray_cast_all(far * 5, near[:100_000] - far)


def sampling() -> Iterator[tuple[str, Call]]:
    yield "area", lambda: surface("quads").area()
    yield "area, triangles", lambda: surface("triangles").area()
    yield "area, pole", lambda: surface("pole").area()
    yield "scatter_jittered", lambda: surface("quads").scatter_jittered(4)
    yield "scatter_jittered, gigabytes", lambda: surface("quads").scatter_jittered(8)
    yield "scatter_uniform", lambda: ls.LimitSurface(mesh("triangles")).scatter_uniform(1_000_000)
    yield "scatter_blue_noise", lambda: surface("middle").scatter_blue_noise(count=100_000)
    yield (
        "scatter_blue_noise, triangles",
        lambda: surface("triangles").scatter_blue_noise(count=50_000),
    )
    edges = edges_of(positions_and_faces("middle")[1])
    yield "edge_curves", lambda: surface("middle").edge_curves(edges)
    border = surface("middle").edge_curves()
    yield (
        "scatter_along, rows",
        lambda: surface("middle").scatter_along(border, 20_000, rows=20, row_distance=0.3),
    )


def hostile() -> Iterator[tuple[str, Call]]:
    """Meshes on which single searches or cells take long, of whatever thread."""
    rng = np.random.default_rng(5)
    count = 15_000
    angle = 2 * np.pi * np.arange(count) / count
    rim = np.stack([np.cos(angle), np.sin(angle), np.full(count, 0.5)], 1)
    around = np.stack([np.zeros(count, int), np.ones(count, int), np.arange(count) + 2], 1)
    book = ls.ControlMesh.from_faces(np.vstack([[[0, 0, 0], [0, 0, 1.0]], rim]), around)
    yield "LimitSurface, 15,000 faces on one edge", lambda: ls.LimitSurface(book)
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    stack = ls.LimitSurface(
        ls.ControlMesh.from_faces(np.tile(square, (400, 1)), np.arange(1600).reshape(-1, 4))
    )
    within = [[-1, -1, 0]] * 4, [[1.0, 1, 0]] * 4
    yield "ray_cast_all, within 400 sheets", lambda: stack.ray_cast_all(*within)
    same = ls.LimitSurface(ls.ControlMesh.from_faces(square, np.tile(np.arange(4), (1000, 1))))
    corners = np.round(rng.random((300, 3))) * [1, 1, 0]
    chords = np.roll(corners, 1, 0) - corners + [1e-9, 0, 0]
    yield "ray_cast, 1,000 equal faces", lambda: same.ray_cast(corners, chords)
    tip = rng.normal(size=(2000, 3)) * [0.1, 0.1, 0.2] + [0, 0, 0.9]
    pole = ls.ControlMesh.from_faces(*shapes.pole(count))
    yield "closest, first call at a pole", lambda: ls.LimitSurface(pole).closest(tip)
    _, quads = shapes.grid(8, 8)
    needles = rng.normal(size=(81, 3)) * [1, 1e-8, 1e-8]
    thin = ls.LimitSurface(ls.ControlMesh.from_faces(needles, quads))
    yield "scatter_blue_noise, needles", lambda: thin.scatter_blue_noise(count=500)


def tracing() -> Iterator[tuple[str, Call]]:
    middle, rng = surface("middle"), np.random.default_rng(0)
    line = np.stack([np.linspace(0, 300, 300), np.linspace(0, 300, 300), np.zeros(300)], 1)
    guides, at = places("middle", 1000), places("middle", 500_000)
    yield "guide_weights", lambda: middle.guide_weights(*guides, *at)
    yield "curve_directions", lambda: middle.curve_directions(line, None, *at)
    begins = rng.random((500_000, 1, 3)) * [299, 299, 0]
    short = (begins + [[0, 0, 0], [0.5, 0.5, 0]]).reshape(-1, 3)
    ends = np.arange(0, len(short) + 1, 2)
    cut_by = {"cut_points": short[:200_000], "cut_offsets": ends[:100_001]}
    yield "guide_weights, 100,000 curves", lambda: middle.guide_weights(*guides, *at, **cut_by)
    yield (
        "curve_directions, 500,000 curves",
        lambda: middle.curve_directions(short, ends, *at),
    )
    yield "lay_path", lambda: middle.lay_path(line, 1e-6)
    path = middle.lay_path(line, 1e-3)
    some = (path.face, path.uv)
    yield "fit_path", lambda: middle.fit_path(*some, 1e-5)
    yield (
        "smooth_path",
        lambda: middle.smooth_path(*some, np.ones(len(path.face)), iterations=200),
    )
    yield "even_path", lambda: middle.even_path(*some, 200_000)
    yield "even_path, 10 million", lambda: middle.even_path(*some, 10_000_000)
    points = rng.random((8_000_000, 3))
    offsets = np.arange(0, len(points) + 1, 8)
    yield "resample_strands", lambda: ls.resample_strands(points, offsets, 16)


def texturing() -> Iterator[tuple[str, Call]]:
    middle, texture, rng = surface("middle"), uv_map("middle"), np.random.default_rng(0)
    at = places("middle", 1_000_000)
    view = np.diag([1 / 150, 1 / 150, -0.01, 1.0])
    yield "rasterize", lambda: texture.rasterize(3000, 3000, margin=8)
    yield "locate", lambda: texture.locate(rng.random((400_000, 2)))
    yield "project", lambda: middle.project(texture, *at, view, (1e-3, 1e-3))
    yield (
        "project_along_normals",
        lambda: middle.project_along_normals(
            texture, at[0][:200_000], at[1][:200_000], middle, texture, (1e-3, 1e-3)
        ),
    )
    fine = positions_and_faces("middle")
    yield "SubdividedFaces", lambda: ls.SubdividedFaces(mesh("middle"), subdivided())
    yield (
        "scalar_displacement",
        lambda: middle.scalar_displacement(middle, at[0][:300_000], at[1][:300_000]),
    )
    pixels = rng.random((4096, 4096, 4), np.float32)
    yield "FilteredImage", lambda: ls.FilteredImage(pixels)
    image = ls.FilteredImage(pixels)
    steps = rng.uniform(-0.05, 0.05, (3_000_000, 2, 2))
    yield "sample", lambda: image.sample(rng.random((3_000_000, 2)), steps)
    grey, boxes = ls.FilteredImage(pixels[:, :, :1]), rng.random((6_000_000, 2, 2))
    boxes.sort(axis=1)
    yield "bounds of an image", lambda: grey.bounds(boxes)
    colours = rng.random((8_000_000, 4), np.float32)
    yield (
        "blend_over",
        lambda: ls.blend_over(colours, colours, np.ones(len(colours)), premultiplied=True),
    )
    normals = rng.normal(size=(8_000_000, 3))
    yield "box_weights", lambda: ls.box_weights(normals, 0.5)
    yield "bilinear", lambda: ls.bilinear(pixels, rng.random((8_000_000, 2)))
    layout = ls.PtexLayout(len(fine[1]), 16)
    yield "PtexLayout.texels", lambda: layout.texels()
    signs = np.ones(len(normals))
    yield (
        "into_shading_frames",
        lambda: ls.into_shading_frames(normals, normals, normals[::-1], signs),
    )
    yield "shortest_turns", lambda: ls.shortest_turns(normals, normals[::-1])


@cache
def subdivided() -> ls.ControlMesh:
    """The mesh "middle", subdivided once."""
    points, faces = positions_and_faces("middle")
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], 2).reshape(-1, 2), axis=1)
    edges, edge_of_side = np.unique(sides, axis=0, return_inverse=True)
    edge = len(points) + edge_of_side.reshape(-1, 4)
    centre = len(points) + len(edges) + np.arange(len(faces))[:, None].repeat(4, 1)
    before = np.roll(edge, 1, axis=1)
    children = np.stack([faces, edge, centre, before], 2)  # each begins at its corner of the face
    for corner in range(4):  # as OpenSubdiv does, a child keeps the number of that corner
        children[:, corner] = np.roll(children[:, corner], corner, axis=1)
    vertices = np.zeros((centre[-1, 0] + 1, 3))
    return ls.ControlMesh.from_faces(vertices, children.reshape(-1, 4))


@dataclass
class Finding:
    seconds: float
    deaf: float  # the longest time without hearing a signal
    pause: float  # the longest pause of another thread
    ends: list[float]  # from Ctrl-C to the end, for each of the moments


def measured(call: Call) -> Finding:
    heard: list[float] = []
    over = threading.Event()
    pause = 0.0

    def watch() -> None:
        nonlocal pause
        last = time.perf_counter()
        while not over.is_set():
            time.sleep(0.001)
            now = time.perf_counter()
            pause, last = max(pause, now - last), now

    watcher = threading.Thread(target=watch)
    before = signal.signal(signal.SIGALRM, lambda *_: heard.append(time.perf_counter()))
    watcher.start()
    begin = time.perf_counter()
    signal.setitimer(signal.ITIMER_REAL, TICK, TICK)
    try:
        call()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        end = time.perf_counter()
        over.set()
        watcher.join()
        signal.signal(signal.SIGALRM, before)
    times = np.array([begin, *[t for t in heard if t < end], end])
    return Finding(end - begin, float(np.diff(times).max()), pause, [])


def interrupted(call: Call, after: float) -> float | None:
    """The time from Ctrl-C to the end, or None where the call had ended before."""
    asked = 0.0

    def press() -> None:
        nonlocal asked
        asked = time.perf_counter()
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(after, press)
    ended: float | None = None
    try:
        timer.start()
        try:
            call()
            timer.cancel()
        except KeyboardInterrupt:
            ended = time.perf_counter() - asked
        timer.join()
        time.sleep(0.01)  # it may have come after the end
    except KeyboardInterrupt:
        pass
    return ended


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    arguments.add_argument("names", nargs="*", help="parts of the names of calls")
    arguments.add_argument("--heard-only", action="store_true", help="do not press Ctrl-C")
    given = arguments.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    print(
        "| call | takes | longest wait for Ctrl-C | until it has ended the call "
        "| longest pause of another thread |"
    )
    print("|---|---:|---:|---:|---:|")
    slow = []
    for group in (making, posing, evaluating, searching, sampling, hostile, tracing, texturing):
        for name, call in group():
            if given.names and not any(part in name for part in given.names):
                continue
            found = measured(call)
            if not given.heard_only:
                ends = (interrupted(call, part * found.seconds) for part in MOMENTS)
                found.ends = [end for end in ends if end is not None]
            ended = f"{1000 * max(found.ends):.0f} ms" if found.ends else ""
            print(
                f"| `{name}` | {found.seconds:.1f} s | {1000 * found.deaf:.0f} ms | {ended} "
                f"| {1000 * found.pause:.0f} ms |",
                flush=True,
            )
            if max([found.deaf, *found.ends]) > LIMIT:
                slow.append(name)
    print()
    print("Slower than half a second:", ", ".join(slow) or "none")


if __name__ == "__main__":
    main()
