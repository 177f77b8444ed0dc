# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about object.limit_mesh: its examples run, its table matches the operator, and its
picture shows what the operator makes.
"""

import bpy
import pages
import pytest
import scenes
from figures import comparison, limit_mesh
from processes import ROOT

PAGE = pages.text("limit_mesh")
EXAMPLES = pages.examples(PAGE)


def test_example_in_blender(capsys):
    scenes.cross()
    exec(EXAMPLES[0], {})
    count = int(capsys.readouterr().out.split()[-2])
    assert count == len(bpy.context.active_object.data.polygons) > 100


def test_example_without_blender(capsys):
    known = {}
    exec(EXAMPLES[1], known)
    assert "is a triangle" in capsys.readouterr().out
    assert known["chosen"].measure.max() <= 0.001


def test_table_lists_the_properties_and_their_defaults():
    pages.check_properties(PAGE.split("## Levels")[0], "limit_mesh")


@pytest.mark.slow
def test_picture_is_what_the_operator_makes(tmp_path):
    limit_mesh.make(tmp_path, samples=4)
    mean, worst = comparison.of_renders(
        tmp_path / "limit_mesh.png", ROOT / "docs/images/limit_mesh.png"
    )
    assert mean < 0.8
    assert worst < 16
