# SPDX-License-Identifier: GPL-3.0-or-later
"""The command of the installed extension, run by Blender's executable without a window."""

import os
import subprocess

import numpy as np
import pytest
from session import LIMIT, install_extension

MAKE_SHOT = """
import bpy
cube = bpy.data.objects["Cube"]
cube.modifiers.new("Wave", "WAVE")
cube.modifiers.new("Subdivision", "SUBSURF")
bpy.context.view_layer.objects.active = cube
bpy.ops.object.limit_hair_add(per_side=2)
hair = bpy.context.object
for frame, height in ((1, 0), (5, 2)):
    cube.location.z = height
    cube.keyframe_insert("location", frame=frame)
bpy.ops.wm.save_as_mainfile(filepath={file!r})
"""
FACES = 6


def run(user, *arguments):
    return subprocess.run(
        ["blender", *map(str, arguments)],
        env={**os.environ, "BLENDER_USER_RESOURCES": str(user)},
        capture_output=True,
        text=True,
        timeout=LIMIT,
    )


@pytest.fixture(scope="module")
def user(tmp_path_factory):
    """Returns a folder of a user who has enabled the extension, and has a file shot.blend."""
    folder = tmp_path_factory.mktemp("user")
    install_extension(folder)
    program = MAKE_SHOT.format(file=str(folder / "shot.blend"))
    done = run(folder, "-b", "--python-exit-code", 9, "--python-expr", program)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def bake(user, out, *arguments, file="shot.blend"):
    command = ("--command", "limit_surface", "bake", "--objects", "Cube", "Limit Hair")
    return run(user, "-b", user / file, *command, "--output", out, *arguments)


def test_frames_are_baked(user, tmp_path):
    done = bake(user, tmp_path, "--frames", "1-5", "--step", "2", "--format", "npz")
    assert done.returncode == 0, done.stdout + done.stderr
    lines = [line for line in done.stdout.splitlines() if line.startswith("limit_surface: frame")]
    assert [line.split()[2] for line in lines] == ["1", "3", "5"]
    heights, roots = [], []
    for frame in (1, 3, 5):
        with np.load(tmp_path / f"Limit Hair.{frame:04}.npz") as arrays:
            assert arrays["limit_face"].shape == (FACES * 2**2,)
            heights.append(arrays["matrix_world"][2, 3])
            roots.append(arrays["position"][arrays["curve_offsets"][:-1]])
    np.testing.assert_allclose(heights, [0, 1, 2], atol=1e-6)
    assert np.abs(roots[1] - roots[0]).max() > 1e-3  # the hair follows the wave


@pytest.mark.slow
def test_frames_that_exist_are_left(user, tmp_path):
    first = bake(user, tmp_path, "--frames", "1-5", "--step", "2", "--format", "npz")
    assert first.returncode == 0
    again = bake(user, tmp_path, "--frames", "1-5", "--step", "2", "--format", "npz")
    assert again.returncode == 0
    assert "6 existed" in again.stdout


@pytest.mark.slow
def test_exit_codes(user, tmp_path):
    unknown = run(
        *(user, "-b", user / "shot.blend", "--command", "limit_surface", "bake", "--frames", "1"),
        *("--objects", "Nobody", "--output", tmp_path / "out", "--format", "npz"),
    )
    assert unknown.returncode == 2
    assert "has no object Nobody" in unknown.stderr
    missing = bake(user, tmp_path / "out", "--frames", "1", "--format", "npz", file="missing.blend")
    assert missing.returncode == 2
    assert "no file is open" in missing.stderr
    (tmp_path / "Cube.0001.npz").mkdir()
    failed = bake(user, tmp_path, "--frames", "1", "--format", "npz", "--overwrite")
    assert failed.returncode == 1
    assert "1 written, 1 failed" in failed.stdout
    assert not (tmp_path / "out").exists()


def test_a_blender_without_alembic_says_so(user, tmp_path):
    """Debian's Blender is built without it."""
    done = bake(user, tmp_path, "--frames", "1", "--format", "abc")
    assert done.returncode == 2
    assert "built without Alembic: use another one, or --format npz" in done.stderr
