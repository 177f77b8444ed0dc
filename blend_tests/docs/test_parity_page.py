# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of distances between Blender's meshes and the limit surface."""

import re
import subprocess
import sys

import pytest
from figures.parity import zoo as parity_zoo
from processes import ROOT

PAGE = (ROOT / "docs/accuracy.md").read_text()
NAMES = ("best positions", "best uvs", "default positions", "default uvs")
LAGGING = "lagging"


def table(page, name):
    """Returns the entries by mesh and kind of creases: the first number of each."""
    (lines,) = re.findall(rf"<!-- {name} -->\n\n(.*?)\n\n<!-- end -->", page, re.DOTALL)
    head, _, *rows = ([c.strip() for c in line.split("|")[1:-1]] for line in lines.splitlines())
    return {
        (row[0], kind): float(cell.split()[0])
        for row in rows
        for kind, cell in zip(head[1:], row[1:], strict=True)
    }


@pytest.mark.parametrize("name", NAMES)
def test_tables_cover_the_zoo(name):
    found = table(PAGE, name)
    assert set(found) == {(m, k) for m in parity_zoo.MESHES for k in parity_zoo.CREASES}
    if name.startswith("best"):
        assert max(found.values()) <= 1e-6
    else:
        assert max(found.values()) > 5e-3


def test_what_is_left_out_comes_nearer_with_the_quality():
    found = table(PAGE, LAGGING)
    for part in ("positions", "UVs"):
        distances = [found[part, quality] for quality in ("4", "6", "8", "10")]
        assert distances == sorted(distances, reverse=True)
        assert 1e-6 < distances[-1] < 1e-4 < distances[0]


@pytest.mark.slow
def test_program_writes_the_page(tmp_path):
    output = tmp_path / "accuracy.md"
    program = (sys.executable, str(ROOT / "docs/figures/make.py"), "parity_tables")
    done = subprocess.run(
        [*program, "--output", str(tmp_path)], capture_output=True, text=True, timeout=1800
    )
    assert done.returncode == 0, done.stdout + done.stderr
    written = output.read_text()
    for name in (*NAMES, LAGGING):
        fresh, kept = table(written, name), table(PAGE, name)
        assert set(fresh) == set(kept)
        if not name.startswith("best"):
            for key, value in fresh.items():
                assert value == pytest.approx(kept[key], rel=0.5, abs=1e-6), (name, key)
    text = re.compile(r"^\|.*\n", re.MULTILINE)
    assert text.sub("", written) == text.sub("", PAGE)
