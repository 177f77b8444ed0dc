# SPDX-License-Identifier: Apache-2.0
"""What the README shows is what runs."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CONSUMER = ROOT / "native/tests/consumer"


def blocks(kind: str) -> list[str]:
    """The README's code blocks that open with exactly ```kind."""
    readme = (ROOT / "README.md").read_text()
    return re.findall(rf"^```{kind}\n(.*?)^```$", readme, flags=re.MULTILINE | re.DOTALL)


def without_licence_line(path: Path) -> str:
    return path.read_text().split("\n", 1)[1]


def run(code: str, folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_python_examples_run_one_after_the_other(tmp_path):
    examples = blocks("python")
    assert examples
    run("\n".join(examples), tmp_path)


def test_blender_example_makes_hair(tmp_path):
    pytest.importorskip("bpy")
    (example,) = blocks("python blender")
    # A process of the `bpy` module does not end while classes are registered.
    before = (
        f"import sys; sys.path.insert(0, {str(ROOT / 'addon')!r})\n"
        "import limit_surface; limit_surface.register()\n"
    )
    after = "limit_surface.unregister()\n"
    faces = 6 * 4
    assert f"has {faces * 20 * 20} strands" in run(before + example + after, tmp_path)


@pytest.mark.parametrize(("kind", "file"), [("cpp", "main.cpp"), ("cmake", "CMakeLists.txt")])
def test_cpp_example_is_the_one_that_is_built(kind, file):
    assert blocks(kind) == [without_licence_line(CONSUMER / file)]
