# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about farms: its commands run, and its tables are those of the command."""

import os
import re
import subprocess

import bpy
import numpy as np
import pages
import pytest
import scenes
from bakes import blender_executable, contents
from farm_software import slurm
from limit_surface.bake_frames import arguments, command
from processes import ROOT, run_python

PAGE = pages.text("farm")


@pytest.fixture
def shot(tmp_path, monkeypatch):
    """Goes to a folder with the files that the page names."""
    sheet = scenes.flat_grid(3)
    sheet.modifiers.new("Wave", "WAVE").height = 0.4
    scenes.add_subsurf(sheet)
    hair = scenes.add_hair(sheet, per_side=2)
    assert hair.name == "Limit Hair"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    (tmp_path / "docs").symlink_to(ROOT / "docs")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PWD", str(tmp_path))  # by which Blender knows the folder
    return tmp_path


def shell(kind, **environment):
    (block,) = re.findall(rf"^```sh {kind}\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    return subprocess.run(
        ["bash", "-ec", block],
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ | environment,
    )


def path_with(*folders):
    return os.pathsep.join([*map(str, folders), os.environ["PATH"]])


def caches(folder, suffix):
    return {f"Limit Hair.{frame:04}{suffix}" for frame in range(1, 25)} == (
        contents(folder / "caches").keys() - {"bake.json"}
    )


def test_the_command(shot):
    blender_executable(shot)
    done = shell("blender", PATH=path_with(shot))
    assert done.returncode == 0, done.stdout + done.stderr
    assert caches(shot, ".abc")
    shown = re.findall(r"^(limit_surface: .*)$", PAGE, re.MULTILINE)
    lines = [line for line in done.stdout.splitlines() if line.startswith("limit_surface")]
    known = re.compile(r"\d\.\d\d s|/\S*caches")
    assert [known.sub("", line) for line in shown] == [
        known.sub("", line) for line in (*lines[:2], lines[-1])
    ]


def test_examples_in_python(shot):
    loading, baking = pages.examples(PAGE)
    known = {}
    (shot / "addon").symlink_to(ROOT / "addon")
    run_python(baking)
    assert caches(shot, ".npz")
    exec(loading, known)
    bpy.context.scene.frame_set(24)
    hair = bpy.data.objects["Limit Hair"]
    shown = hair.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    np.testing.assert_array_equal(known["roots"][0], shown.points[0].position)
    assert len(known["roots"]) == len(shown.curves)


def rows(heading):
    (table,) = re.findall(rf"^\| {heading} \|.*\n\|[-|]+\|\n((?:\|.*\n)+)", PAGE, re.MULTILINE)
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]


def test_the_table_of_options():
    (commands,) = (a for a in arguments._parser()._actions if a.dest == "command")
    known = [a for a in commands.choices["bake"]._actions if a.dest != "help"]
    options = {a.option_strings[0]: a for a in known}
    table = {name.strip("`"): (default.strip("`"), text) for name, default, text in rows("option")}
    assert {name: default for name, (default, _) in table.items()} == {
        name: "required" if a.required else "off" if a.default is False else str(a.default)
        for name, a in options.items()
    }
    forms = re.findall(r"`(\w+)`", table["--format"][1])
    assert forms == list(options["--format"].choices)


def test_the_table_of_exit_codes():
    codes = (command.DONE, command.FRAMES_FAILED, command.BAD_ARGUMENTS, command.STALE_BINDING)
    assert [int(row[0]) for row in rows("exit code")] == list(codes)


@pytest.mark.slow
def test_open_job_description(shot):
    from farm_software import python_environment

    blender_executable(shot)
    done = shell("openjd", PATH=path_with(shot, python_environment() / "bin"))
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Chunks run: 2" in done.stdout
    assert caches(shot, ".abc")


@pytest.mark.slow
def test_slurm(shot):
    with slurm() as environment:
        environment |= {"BLENDER": str(blender_executable(shot)), "SBATCH_OPTIONS": "--wait"}
        done = shell("slurm", **environment)
    assert done.returncode == 0, done.stdout + done.stderr
    assert caches(shot, ".abc")
