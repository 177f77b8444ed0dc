# SPDX-License-Identifier: Apache-2.0
"""The examples in the README and in the pages about the Python module and the C++ library run."""

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CONSUMER = ROOT / "native/tests/consumer"


def blocks(page: str, kind: str) -> list[str]:
    """Returns the page's code blocks that open with exactly ```kind."""
    text = (ROOT / page).read_text()
    return re.findall(rf"^```{kind}\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)


def without_licence_line(path: Path) -> str:
    return path.read_text().split("\n", 1)[1]


def run(code: str, folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_python_examples_run_one_after_the_other(page, tmp_path):
    examples = blocks(page, "python")
    assert examples
    run("\n".join(examples), tmp_path)


def test_blender_example_makes_hair(tmp_path):
    # This process must not import it: `limitsurf` may have loaded another oneTBB than it needs.
    if importlib.util.find_spec("bpy") is None:
        pytest.skip("the module bpy is not installed")
    (example,) = blocks("README.md", "python blender")
    # A process of the `bpy` module does not end while classes are registered.
    before = (
        f"import sys; sys.path.insert(0, {str(ROOT / 'addon')!r})\n"
        "import limit_surface; limit_surface.register()\n"
    )
    after = "limit_surface.unregister()\n"
    faces = 6 * 4
    assert f"has {faces * 20 * 20} strands" in run(before + example + after, tmp_path)


@pytest.mark.parametrize(
    ("page", "file"), [("README.md", "readme.cpp"), ("docs/cpp.md", "main.cpp")]
)
def test_cpp_programs_are_those_that_are_built(page, file):
    assert blocks(page, "cpp") == [without_licence_line(CONSUMER / file)]


def test_cmake_example_is_what_builds_the_program():
    (example,) = blocks("docs/cpp.md", "cmake")
    assert without_licence_line(CONSUMER / "CMakeLists.txt").startswith(example)


def test_readme_is_short():
    assert len((ROOT / "README.md").read_text().splitlines()) <= 150
