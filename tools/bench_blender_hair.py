# SPDX-License-Identifier: Apache-2.0
"""Hair in Blender: the CPU time of `object.limit_hair_add`, and of its parts, beside the time that
Blender itself needs for as many curves of random points: adding, filling and the first update.

    .venv/bin/python tools/bench_blender_hair.py --hairs 1000000

Times are CPU seconds of all threads, each the smallest of some runs in one process. Blender spends
much of its update on the radii of points, so its own curves are made with radii and without.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "addon"), str(ROOT / "docs")]

import bench_blender_truth as truth  # noqa: E402
import limit_surface  # noqa: E402
from limit_surface.hair import strands  # noqa: E402
from limit_surface.placing import binding, distribution, new_hair, region, scatter_operator  # noqa: E402

POINTS = 8
REPEATS = 3
#: The parts of the operator: what they are called, and the function of each
PARTS = {
    "control mesh, opening, area": (region, "read"),
    "scattering": (distribution.Distribution, "scatter"),
    "positions and frames": (scatter_operator.Ground, "evaluate"),
    "rest rotations": (binding.Binding, "fill"),
    "strands": (strands.StrandMaker, "put"),
    "writing": (new_hair, "add"),
    "putting": (scatter_operator.ScatterOperator, "_put"),
    "Blender's update": (scatter_operator.ScatterOperator, "finish"),
}


class Split:
    """Adds up the CPU seconds within the parts."""

    def __init__(self) -> None:
        self.seconds = dict.fromkeys(PARTS, 0.0)
        for part, (owner, name) in PARTS.items():
            setattr(owner, name, self._timed(part, getattr(owner, name)))

    def _timed(self, part: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*arguments: Any, **options: Any) -> Any:
            begin = time.process_time()
            try:
                return function(*arguments, **options)
            finally:
                self.seconds[part] += time.process_time() - begin

        return timed

    def taken(self) -> dict[str, float]:
        """Returns the seconds since the last time. Blender's update comes after what is put into
        the file, which is mostly writing.
        """
        seconds = dict(self.seconds)
        seconds["Blender's update"] -= seconds.pop("putting")
        self.seconds = dict.fromkeys(PARTS, 0.0)
        return seconds


def removed(ob: bpy.types.Object) -> None:
    curves = ob.data
    bpy.data.objects.remove(ob)
    bpy.data.hair_curves.remove(curves)
    bpy.context.view_layer.update()  # frees Blender's copy, which is no part of the next run


def ours(surface: bpy.types.Object, hairs: int, split: Split) -> dict[str, float]:
    for other in bpy.context.selected_objects:
        other.select_set(False)
    bpy.context.view_layer.objects.active = surface
    surface.select_set(True)
    begin = time.process_time()
    bpy.ops.object.limit_hair_add(
        count=hairs, points=POINTS, distribution="UNIFORM", follow="NONE", allow_large=True
    )
    whole = time.process_time() - begin
    removed(bpy.context.view_layer.objects.active)
    parts = split.taken()
    return {**parts, "the rest": whole - sum(parts.values()), "all": whole}


def blenders(hairs: int, with_radii: bool) -> dict[str, float]:
    points = np.random.default_rng(0).random((hairs * POINTS, 3), dtype=np.float32)
    sizes, radii = [POINTS] * hairs, np.full(hairs * POINTS, 0.005, np.float32)
    begin = time.process_time()
    curves = bpy.data.hair_curves.new("Random")
    curves.add_curves(sizes)
    added = time.process_time()
    curves.attributes["position"].data.foreach_set("vector", points.ravel())
    if with_radii:
        radius = curves.attributes.new("radius", "FLOAT", "POINT")
        radius.data.foreach_set("value", radii)
    filled = time.process_time()
    ob = bpy.data.objects.new("Random", curves)
    bpy.context.scene.collection.objects.link(ob)
    bpy.context.view_layer.update()
    end = time.process_time()
    removed(ob)
    return {
        "adding": added - begin,
        "filling": filled - added,
        "update": end - filled,
        "all": end - begin,
    }


def best(work: Callable[[], dict[str, float]]) -> dict[str, float]:
    return min((work() for _ in range(REPEATS)), key=lambda seconds: seconds["all"])


def listed(seconds: dict[str, float]) -> str:
    return ", ".join(f"{part} {value:.3f}" for part, value in seconds.items())


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--faces", type=int, default=10_000, help="approximate number of faces")
    parser.add_argument(
        "--hairs", type=int, nargs="+", default=[1000, 100_000, 1_000_000], help="numbers of hairs"
    )
    options = parser.parse_args(arguments)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    limit_surface.register()
    surface = truth.add_sheet(round(options.faces**0.5))
    bpy.context.view_layer.update()
    split = Split()
    print(f"Blender {bpy.app.version_string}; CPU seconds of all threads, the best of {REPEATS}")
    for hairs in options.hairs:
        rows = {
            "limit_hair_add": best(lambda hairs=hairs: ours(surface, hairs, split)),
            "Blender": best(lambda hairs=hairs: blenders(hairs, False)),
            "Blender, with radii": best(lambda hairs=hairs: blenders(hairs, True)),
        }
        print(f"\n{hairs:,} hairs of {POINTS} points")
        for name, seconds in rows.items():
            ratio = rows["limit_hair_add"]["all"] / seconds["all"]
            beside = "" if name == "limit_hair_add" else f" ({ratio:.2f} times as long for ours)"
            print(f"  {name}: {listed(seconds)}{beside}")


if __name__ == "__main__":
    main(sys.argv[1:])
