# SPDX-License-Identifier: GPL-3.0-or-later
"""Files play without the extension: the same pixels, and the same positions in other versions of
Blender.
"""

import os
import subprocess
import sys
from pathlib import Path

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import deforming
from limit_surface import ids
from processes import LEAVE, ROOT, run_python

SIZE = 48
FRAMES = ((1, 0.0), (13, 0.5), (30, 0.0))

RENDER = """
import bpy
bpy.ops.wm.open_mainfile(filepath={path!r})
assert "limit_surface" not in sys.modules and "limitsurf" not in sys.modules
assert not hasattr(bpy.types, "OBJECT_OT_limit_follow")
bpy.context.scene.render.filepath = {image!r}
bpy.ops.render.render(animation=True)
"""

PLAY = """
import bpy, numpy as np
bpy.ops.wm.open_mainfile(filepath={path!r})
found = dict()
for frame, subframe in {frames!r}:
    bpy.context.scene.frame_set(frame, subframe=subframe)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for name in {names!r}:
        data = bpy.data.objects[name].evaluated_get(depsgraph).data
        values = np.empty(3 * len(data.attributes["position"].data), np.float32)
        data.attributes["position"].data.foreach_get("vector", values)
        found[f"{{name}} {{frame}} {{subframe}}"] = values
np.savez({out!r}, **found)
"""


def watch(folder: Path) -> None:
    """Sets a camera above the scene, and a cheap render by Cycles."""
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    scene.collection.objects.link(camera)
    camera.location = (0, 0, 20)
    camera.data.type, camera.data.ortho_scale = "ORTHO", 6.0
    scene.camera = camera
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    scene.collection.objects.link(sun)
    sun.rotation_euler = (0.5, 0.3, 0)
    render = scene.render
    render.engine, scene.cycles.samples, scene.cycles.device = "CYCLES", 4, "CPU"
    scene.cycles.use_denoising = False
    render.resolution_x = render.resolution_y = SIZE
    render.film_transparent = True
    render.image_settings.file_format, render.image_settings.color_mode = "PNG", "RGBA"
    render.filepath = str(folder / "with")
    scene.frame_start, scene.frame_end, scene.frame_step = 1, 29, 14


def pixels(path: Path) -> np.ndarray:
    image = bpy.data.images.load(str(path))
    values = np.empty(4 * SIZE * SIZE, np.float32)
    image.pixels.foreach_get(values)
    return values


def furry(thickness: float = 0.03) -> tuple[bpy.types.Object, bpy.types.Object, bpy.types.Object]:
    ob = deforming("cross")
    hair = scenes.add_hair(ob, tilt=(0.4, 0.2), length=0.5, radius=thickness, follow="NODES")
    points = scenes.add_points(ob, follow="NODES")
    return ob, hair, points


def test_pixels_are_the_same_without_the_extension(tmp_path):
    furry()
    watch(tmp_path)
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.render.render(animation=True)
    run_python(RENDER.format(path=path, image=str(tmp_path / "without")))
    seen = []
    for frame in (1, 15, 29):
        own = pixels(tmp_path / f"with{frame:04}.png")
        np.testing.assert_array_equal(own, pixels(tmp_path / f"without{frame:04}.png"))
        assert own[3::4].mean() > 0.05
        seen.append(own)
    assert np.mean(seen[0] != seen[-1]) > 0.02


def python_with(version: str) -> Path:
    """Returns the interpreter of an environment with that Blender: the one that tools/setup.sh has
    made, or one in the folder of builds, which is made if need be.
    """
    made = ROOT / f".venv-{version}/bin/python"
    if made.exists():
        return made
    folder = ROOT / f"build/blender-{version}"
    python = folder / "bin/python"
    for command in (
        [sys.executable, "-m", "venv", str(folder)],
        [str(python), "-m", "pip", "install", "--quiet", f"bpy=={version}", "numpy<2"],
    ):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            pytest.skip(f"Blender {version} cannot be installed: {done.stderr[-200:]}")
    return python


@pytest.mark.slow
@pytest.mark.parametrize("version", ["4.2.23", "5.0.1"])
def test_other_versions_of_blender_play_the_file(version, tmp_path):
    python = python_with(version)
    surface, hair, points = furry()
    names = [hair.name, points.name]
    path, out = str(tmp_path / "a.blend"), str(tmp_path / "found.npz")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    program = PLAY.format(path=path, out=out, frames=FRAMES, names=names)
    alone = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    done = subprocess.run(
        [str(python), "-c", LEAVE.format(program=program)],
        env=alone,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    found = np.load(out)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(surface)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        for ob in (hair, points):
            own = follow_truth.shown(ob, ids.POSITION).ravel()
            error = np.abs(found[f"{ob.name} {frame} {subframe}"] - own).max()
            assert error < bound
