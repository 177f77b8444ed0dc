# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about maps: its examples run, its tables match the operator, and its picture shows what
the operator makes.
"""

import re

import bpy
import pages
import pytest
from figures import bake_maps, comparison
from limit_surface.bake_maps.maps import KINDS
from processes import ROOT

PAGE = pages.text("bake_maps")
PICTURE = ROOT / "docs/images/bake_maps.png"
EXAMPLES = pages.examples(PAGE)


def test_example_in_blender(capfd):
    bpy.ops.mesh.primitive_cube_add()
    exec(EXAMPLES[0], {})
    assert "['Cube Cavity', 'Cube Tangent Normal']" in capfd.readouterr().out


def test_example_without_blender(capsys):
    exec(EXAMPLES[1], {})
    count, sign, area = (float(word) for word in capsys.readouterr().out.split())
    assert count > 64**2 / 3
    assert sign > 0.999
    assert 0.5 < area < 1.1


def test_table_lists_the_properties_and_their_defaults():
    pages.check_properties(PAGE.split("## The maps")[0], "limit_bake_maps")


def test_table_lists_the_maps():
    section = PAGE.split("## The maps")[1].split("\n## ")[0]
    rows = re.findall(r"^\| (`[^|]+`) \| ([^|]+?) \|", section, re.MULTILINE)
    listed = {}
    for keys, names in rows[1:] if rows[0][0] == "`maps`" else rows:
        listed |= zip(re.findall(r"`(\w+)`", keys), names.split(", "), strict=True)
    assert listed == {key: kind.name for key, kind in KINDS.items()}


@pytest.mark.slow
@pytest.mark.skipif(
    bpy.app.version >= (5, 0), reason="suns are brighter there than in the committed picture"
)
def test_picture_is_what_the_operator_gives(tmp_path):
    bake_maps.make(tmp_path, samples=4)
    mean, worst = comparison.of_renders(tmp_path / "bake_maps.png", PICTURE)
    assert mean < 0.7
    # the edges of shadows differ with few samples; with a wrong map the difference is 125
    assert worst < 40
