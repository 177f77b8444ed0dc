# SPDX-License-Identifier: Apache-2.0
"""Long tasks in Blender: how many seconds operators of the extension take for what is large. Prints
a table in Markdown.

    .venv/bin/python tools/bench_blender_tasks.py [NAME ...]

Wall times and CPU seconds of all threads, each the smallest of some runs. The surface is an open,
wavy mesh of about 10,000 faces with holes and some triangles.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "addon"), str(ROOT / "docs")]

import bench_blender_truth as truth  # noqa: E402
import limit_surface  # noqa: E402
from limit_surface.reading import attributes  # noqa: E402

SIDE, POINTS = 100, 8
REPEATS = 3
SIZE = 4096
COUNT = 1_000_000

#: What is timed, on what has been set up
Task = Callable[[], object]


def sheet() -> bpy.types.Object:
    """Adds the surface, with a UV map from above."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    ob = truth.add_sheet(SIDE)
    positions = attributes.read(ob.data, "position")
    corners = positions[attributes.read(ob.data, ".corner_vert")]
    low, high = positions.min(axis=0), positions.max(axis=0)
    uv = ((corners - low) / (high - low))[:, :2].astype(np.float32)
    ob.data.uv_layers.new(name="Flat").data.foreach_set("uv", uv.ravel())
    bpy.context.view_layer.objects.active = ob
    ob.select_set(True)
    bpy.context.view_layer.update()
    return ob


def position_bake(size: int, _count: int) -> Task:
    sheet()
    return lambda: bpy.ops.object.limit_bake_maps(
        maps={"POSITION"}, width=size, height=size, reuse=True, allow_large=True
    )


def snapped_vertices(_size: int, count: int) -> Task:
    """Vertices within half the width of a face from the surface, in Edit Mode."""
    ob = sheet()
    rng = np.random.default_rng(0)
    positions = attributes.read(ob.data, "position")
    near = positions[rng.integers(0, len(positions), count)] + rng.uniform(-0.5, 0.5, (count, 3))
    mesh = bpy.data.meshes.new("Points")
    mesh.vertices.add(count)
    attributes.write(mesh, "position", "FLOAT_VECTOR", "POINT", near)
    points = bpy.data.objects.new("Points", mesh)
    bpy.context.collection.objects.link(points)
    ob.select_set(False)
    points.select_set(True)
    bpy.context.view_layer.objects.active = points
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.context.scene.limit_surface.target = ob
    return lambda: bpy.ops.object.limit_snap()


def hair(count: int) -> bpy.types.Object:
    sheet()
    bpy.ops.object.limit_hair_add(
        distribution="UNIFORM", count=count, points=POINTS, follow="NONE", allow_large=True
    )
    made = bpy.context.active_object
    made.data.set_types(type="POLY")  # Blender evaluates other curves between their points
    bpy.context.view_layer.update()
    return made


def following(mode: str) -> Callable[[int, int], Task]:
    def task(_size: int, count: int) -> Task:
        hair(count)
        return lambda: bpy.ops.object.limit_follow(mode=mode)

    return task


def rebinding(method: str, mode: str) -> Callable[[int, int], Task]:
    def task(_size: int, count: int) -> Task:
        hair(count)
        bpy.ops.object.limit_follow(mode=mode)
        return lambda: bpy.ops.object.limit_rebind(method=method)

    return task


def unbinding(mode: str, shape: str) -> Callable[[int, int], Task]:
    def task(_size: int, count: int) -> Task:
        hair(count)

        def again() -> None:
            bpy.ops.object.limit_unbind(shape=shape)

        bpy.ops.object.limit_follow(mode=mode)
        return again

    return task


def sample_tables(_size: int, _count: int) -> Task:
    sheet()
    return lambda: bpy.ops.object.limit_sample_tables()


TASKS: dict[str, tuple[str, Callable[[int, int], Task], int]] = {
    # name: what the table calls it, what sets it up, how often it can be repeated
    "bake": ("position bake", position_bake, REPEATS),
    "snap": ("snapping vertices", snapped_vertices, 1),
    "follow-nodes": ("follow by nodes", following("NODES"), 1),
    "follow-live": ("follow live", following("LIVE"), 1),
    "rebind-nodes": ("rebind, by nodes, closest", rebinding("CLOSEST", "NODES"), REPEATS),
    "rebind-live": ("rebind, live, closest", rebinding("CLOSEST", "LIVE"), REPEATS),
    "rebind-face": ("rebind, by nodes, face", rebinding("FACE", "NODES"), REPEATS),
    "unbind-nodes": ("unbind, by nodes, as shown", unbinding("NODES", "SHOWN"), 1),
    "unbind-live": ("unbind, live, as shown", unbinding("LIVE", "SHOWN"), 1),
    "tables": ("tables of all tiles", sample_tables, REPEATS),
}


def timed(task: Task, repeats: int) -> tuple[float, float]:
    """Returns the smallest wall time and the smallest CPU time, in seconds."""
    walls, cpus = [], []
    for _ in range(repeats):
        wall, cpu = time.perf_counter(), time.process_time()
        task()
        cpus.append(time.process_time() - cpu)
        walls.append(time.perf_counter() - wall)
    return min(walls), min(cpus)


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(TASKS)}")
    parser.add_argument("--size", type=int, default=SIZE, help="width and height of images")
    parser.add_argument("--count", type=int, default=COUNT, help="number of vertices or roots")
    options = parser.parse_args(arguments)
    limit_surface.register()
    print(
        f"Blender {bpy.app.version_string}; {options.size} x {options.size} texels, "
        f"{options.count:,} vertices or roots\n\n| | s | CPU s |\n|---|---:|---:|"
    )
    for name in options.names or TASKS:
        what, set_up, repeats = TASKS[name]
        wall, cpu = timed(set_up(options.size, options.count), repeats)
        print(f"| {what} | {wall:.2f} | {cpu:.2f} |", flush=True)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    finally:
        limit_surface.unregister()  # otherwise Blender as a module never ends
