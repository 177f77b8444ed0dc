# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs that bake the same file at the same time."""

import bpy
import live_scenes
import pytest
import scenes
from bakes import contents, start

NAMES = ("Flat", "Limit Hair", "Limit Points", "Live")


@pytest.fixture
def file(tmp_path):
    sheet = scenes.flat_grid(5)
    sheet.modifiers.new("Wave", "WAVE").height = 0.4
    scenes.add_subsurf(sheet)
    scenes.add_hair(sheet, per_side=3)
    scenes.add_points(sheet, per_side=3)
    live = scenes.add_hair(sheet, per_side=2, follow="NONE")
    live.name = "Live"
    live_scenes.follow(live)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    return tmp_path / "shot.blend"


def finish(*jobs):
    for job in jobs:
        out, err = job.communicate(timeout=120)
        assert job.returncode == 0, out + err


@pytest.mark.parametrize("form", ["abc", *scenes.slow("npz", "usd", "usda")])
def test_two_ranges_are_one_run_bit_for_bit(file, tmp_path, form):
    def job(folder, frames):
        return start(
            file,
            *("bake", f"--frames={frames}", "--objects", *NAMES),
            *("--output", str(tmp_path / folder), "--format", form),
        )

    finish(job("one", "1-6"))
    finish(job("two", "1-3"), job("two", "4-6"))
    one, two = contents(tmp_path / "one"), contents(tmp_path / "two")
    assert len(one) == 6 * len(NAMES) + 1
    assert one == two


def test_a_job_that_is_killed_is_taken_up_again(file, tmp_path):
    arguments = ("bake", "--frames=1-80", "--objects", "Limit Hair", "--format", "npz")
    killed = start(file, *arguments, "--output", str(tmp_path / "killed"))
    for line in killed.stdout:
        if "frame 8 " in line:
            break
    killed.kill()
    killed.communicate(timeout=60)
    before = contents(tmp_path / "killed")
    names = {name for name in before if not name.startswith(".partial")}
    assert 8 < len(names) < 80
    finish(start(file, *arguments, "--output", str(tmp_path / "killed")))
    finish(start(file, *arguments, "--output", str(tmp_path / "whole")))
    after = contents(tmp_path / "killed")
    whole = contents(tmp_path / "whole")
    assert {name: after[name] for name in whole} == whole
    assert all(name.startswith(".partial") for name in after.keys() - whole.keys())
