# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about curvature: its examples run, its table matches the operator, and its picture shows
what the operator makes.
"""

import re

import bpy
import pages
import pytest
import scenes
from figures import comparison, curvature
from limit_surface import ids
from processes import ROOT

PAGE = pages.text("curvature")
EXAMPLES = pages.examples(PAGE)


def test_example_in_blender(capsys):
    scenes.cross()
    exec(EXAMPLES[0], {})
    least, most = (float(number) for number in capsys.readouterr().out.split()[-2:])
    assert least < most


def test_example_without_blender(capsys):
    exec(EXAMPLES[1], {})
    numbers = [float(n) for n in re.findall(r"-?\d+\.\d+|nan", capsys.readouterr().out)]
    assert numbers[1] != numbers[1]
    said = re.search(r"at a cube's corner it is (\S+) for 1/2, (\S+) for 1/64", PAGE)
    assert numbers[2:] == pytest.approx([float(n) for n in said.groups()], abs=0.05)


def test_table_lists_the_properties_and_their_defaults():
    pages.check_properties(PAGE.split("## What is stored")[0], "limit_curvature")


def test_page_lists_the_attributes():
    stored = {getattr(ids, name) for name in dir(ids) if name.startswith("CURVATURE_")}
    section = PAGE.split("## What is stored")[1].split("\n## ")[0]
    rows = set(re.findall(r"`(limit_curvature_\w+)`", section))
    assert rows == stored - {ids.CURVATURE_OBJECT}


@pytest.mark.slow
@pytest.mark.skipif(
    bpy.app.version >= (5, 0), reason="suns are brighter there than in the committed picture"
)
def test_picture_is_what_the_operator_gives(tmp_path):
    curvature.make(tmp_path, samples=2)
    mean, worst = comparison.of_renders(
        tmp_path / "curvature.png", ROOT / "docs/images/curvature.png"
    )
    assert mean < 1
    assert worst < 16
