# SPDX-License-Identifier: GPL-3.0-or-later
"""The cost of hair that follows a deforming surface: each way of following is compared with
Blender's own node *Deform Curves on Surface*. Prints a table in Markdown.

    .venv/bin/python tools/bench_follow.py [COUNT ...] [--level N] [--catmull-rom] [--triangles]

Each row has a file of its own: an open, wavy mesh of about 10,000 faces with holes, bent by a shape
key, and so many strands of 8 points. With --triangles its faces are triangles. The mesh is
subdivided for display up to level N, by default 0. Strands are polylines, or Catmull-Rom curves as
the extension makes them: Blender evaluates those between their points in each frame. Times are of
the processor, over all cores: the smallest of several frames, and for binding one call.
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
from figures.follow import deform_by_blender  # noqa: E402
from limit_surface.reading import attributes  # noqa: E402

COUNTS = (10_000, 100_000, 1_000_000)
SIDE, POINTS = 100, 8
TRIANGLE_SIDE = 71  # two triangles for each quad
FRAMES = 20  # live following prepares roots on irregular faces after twelve


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("counts", nargs="*", type=int, default=COUNTS, metavar="COUNT")
    parser.add_argument("--level", type=int, default=0, metavar="N")
    parser.add_argument("--catmull-rom", action="store_true")
    parser.add_argument("--triangles", action="store_true")
    options = parser.parse_args()
    print("| roots | followed by | bind, s | ms a frame | bytes a root in the file |")
    print("|---:|---|---:|---:|---:|")
    for count in options.counts:
        for name, bind in WAYS.items():
            hair = add_hair(count, options.level, options.catmull_rom, options.triangles)
            before = file_size()
            begin = time.process_time()
            bind(hair)
            bound = time.process_time() - begin
            size = (file_size() - before) / count
            print(
                f"| {count:,} | {name} | {bound:.2f} | {frame_time():.1f} | {size:.0f} |",
                flush=True,
            )


def add_hair(
    count: int, level: int, is_smooth: bool, are_triangles: bool = False
) -> bpy.types.Object:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    ob = truth.add_sheet(TRIANGLE_SIDE if are_triangles else SIDE)
    if are_triangles:
        triangulate(ob.data)
    positions = attributes.read(ob.data, "position")
    uv = ob.data.uv_layers.new(name="Flat").data
    corners = positions[attributes.read(ob.data, ".corner_vert")]
    low, high = positions.min(axis=0), positions.max(axis=0)
    uv.foreach_set("uv", ((corners - low) / (high - low))[:, :2].astype(np.float32).ravel())
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Wide")
    key.data.foreach_set("co", (positions * [1.2, 1, 1]).astype(np.float32).ravel())
    for frame, value in ((1, 0.0), (30, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    ob.modifiers[0].levels = level
    bpy.context.view_layer.objects.active = ob
    bpy.ops.object.limit_hair_add(
        distribution="UNIFORM", count=count, points=POINTS, follow="NONE", allow_large=True
    )
    hair = bpy.context.active_object
    if not is_smooth:
        hair.data.set_types(type="POLY")
    return hair


def triangulate(mesh: bpy.types.Mesh) -> None:
    import bmesh  # there is none before bpy was imported

    work = bmesh.new()
    work.from_mesh(mesh)
    bmesh.ops.triangulate(work, faces=work.faces[:])
    work.to_mesh(mesh)
    work.free()


def frame_time() -> float:
    """Returns milliseconds of the processor."""
    found = []
    for frame in range(2, 2 + FRAMES):
        begin = time.process_time()
        bpy.context.scene.frame_set(frame)
        found.append(time.process_time() - begin)
    return 1e3 * min(found)


def file_size() -> int:
    path = Path(bpy.app.tempdir) / "bench_follow.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=False)
    size = path.stat().st_size
    path.unlink()
    return size


def by_nodes(_hair: bpy.types.Object) -> None:
    bpy.ops.object.limit_follow(mode="NODES")


def live(_hair: bpy.types.Object) -> None:
    bpy.ops.object.limit_follow(mode="LIVE")


def by_blender(hair: bpy.types.Object) -> None:
    deform_by_blender(hair.data.surface, hair)


WAYS: dict[str, Callable[[bpy.types.Object], None]] = {
    "nothing": lambda _hair: None,
    "Deform Curves on Surface": by_blender,
    "nodes": by_nodes,
    "live": live,
}


if __name__ == "__main__":
    import limit_surface

    limit_surface.register()
    try:
        main()
    finally:
        limit_surface.unregister()  # otherwise Blender as a module never ends
