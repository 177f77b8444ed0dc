# SPDX-License-Identifier: GPL-3.0-or-later
"""The engines of farms run the templates of the documentation: the caches are those of one run,
byte for byte.
"""

import bpy
import farm_software
import pytest
import scenes
from bakes import blender_executable, contents, start
from processes import ROOT

pytestmark = pytest.mark.slow

TEMPLATES = ROOT / "docs/farm"
NAMES = ("Limit Hair", "Flat")
LAST = 7


@pytest.fixture
def shot(tmp_path):
    sheet = scenes.flat_grid(5)
    sheet.modifiers.new("Wave", "WAVE").height = 0.4
    scenes.add_subsurf(sheet)
    scenes.add_hair(sheet, per_side=3)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "my shot.blend"))
    return tmp_path / "my shot.blend"


@pytest.fixture
def one_run(shot, tmp_path):
    """Returns the files of one run."""
    folder = tmp_path / "one run"
    arguments = ("bake", f"--frames=1-{LAST}", "--objects", *NAMES, "--format", "usd")
    job = start(shot, *arguments, "--output", str(folder))
    out, err = job.communicate(timeout=120)
    assert job.returncode == 0, out + err
    files = contents(folder)
    assert len(files) == LAST * len(NAMES) + 1
    return files


def openjd(*arguments):
    program = farm_software.python_environment() / "bin/openjd"
    return farm_software.run([program, *map(str, arguments)])


def test_open_job_description(shot, one_run, tmp_path):
    template = TEMPLATES / "bake.openjd.yaml"
    extension = ("--extensions", "TASK_CHUNKING")
    checked = openjd("check", template, *extension)
    assert checked.returncode == 0, checked.stdout + checked.stderr
    parameters = {
        "BlenderFile": shot,
        "OutputFolder": tmp_path / "farm",
        "Objects": ";".join(NAMES),
        "Frames": f"1-{LAST}",
        "FramesPerTask": 3,
        "Format": "usd",
        "Blender": blender_executable(tmp_path),
    }
    options = [word for key, value in parameters.items() for word in ("-p", f"{key}={value}")]
    done = openjd("run", template, *extension, *options)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Chunks run: 3" in done.stdout
    assert contents(tmp_path / "farm") == one_run


def test_open_job_description_reports_a_failure(shot, tmp_path):
    options = (
        *("-p", f"BlenderFile={shot}", "-p", f"OutputFolder={tmp_path / 'farm'}"),
        *("-p", "Objects=Nobody", "-p", f"Blender={blender_executable(tmp_path)}"),
    )
    template = TEMPLATES / "bake.openjd.yaml"
    done = openjd("run", template, "--extensions", "TASK_CHUNKING", *options)
    assert done.returncode != 0
    assert "the scene Scene has no object Nobody" in done.stdout + done.stderr


def test_slurm(shot, one_run, tmp_path):
    with farm_software.slurm() as environment:
        environment |= {
            "BLENDER": str(blender_executable(tmp_path)),
            "SBATCH_OPTIONS": "--wait",
        }

        def submit(last, *names):
            arguments = (shot, tmp_path / "farm", 1, last, 3, "usd", *names)
            command = [TEMPLATES / "bake.slurm", *map(str, arguments)]
            return farm_software.run(command, environment, cwd=tmp_path)

        done = submit(LAST, *NAMES)
        logs = "\n".join(path.read_text() for path in sorted(tmp_path.glob("*.log")))
        assert done.returncode == 0, done.stdout + done.stderr + logs
        assert contents(tmp_path / "farm") == one_run
        assert len(list(tmp_path.glob("limit_surface_bake-1_*.log"))) == 3
        assert "frames in" in logs
        assert submit(LAST, "Nobody").returncode == 2
        assert submit(0, *NAMES).returncode == 2
