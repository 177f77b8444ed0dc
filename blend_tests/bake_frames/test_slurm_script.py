# SPDX-License-Identifier: GPL-3.0-or-later
"""The frames that the tasks of the Slurm script bake, with another program in Blender's place."""

import os
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "docs/farm/bake.slurm"


def run(first: str, last: str, frames: str, task: int = 0) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["bash", SCRIPT, "shot.blend", "caches", first, last, frames, "abc", "Limit Hair"],
        env=os.environ | {"BLENDER": "echo", "SLURM_ARRAY_TASK_ID": str(task)},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize(
    ("arguments", "baked"),
    [
        (("1", "24", "12", 1), "13-24"),
        (("0010", "0024", "08", 1), "18-24"),  # not octal
        (("0", "00", "1", 0), "0-0"),
        (("-05", "5", "4", 1), "-1-2"),
    ],
)
def test_frames_of_a_task(arguments, baked):
    done = run(*arguments)
    assert done.returncode == 0, done.stderr
    assert f"--frames={baked} --objects Limit Hair --output caches" in done.stdout


@pytest.mark.parametrize("first", ["a", "1-5", "1.5", ""])
def test_what_is_no_number_is_refused(first):
    done = run(first, "24", "12")
    assert done.returncode == 2
    assert done.stderr == f"{first} is not a whole number\n"
