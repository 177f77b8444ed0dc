# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about children: its examples run, and its table matches the operator."""

import bpy
import pages
import pytest
import scenes
from figures import children, comparison
from processes import ROOT

PAGE = pages.text("children")


def test_examples_run():
    ob = scenes.cross()
    scenes.add_subsurf(ob)
    scenes.add_hair(ob)
    known = {}
    for example in pages.examples(PAGE):
        exec(example, known)
    assert len(bpy.context.active_object.data.curves) == 20_000
    assert known["strands"].shape == (1000, 8, 3)


def test_table_lists_the_properties_and_their_defaults():
    table = PAGE.split("## Properties")[1].split("\n## ")[0]
    own = set(bpy.ops.object.limit_children_add.get_rna_type().properties.keys())
    own -= set(bpy.ops.object.limit_points_add.get_rna_type().properties.keys())
    pages.check_properties(table, "limit_children_add", only=own)


@pytest.mark.slow
def test_picture_is_what_the_operator_makes(tmp_path):
    children.make(tmp_path, samples=4)
    mean, worst = comparison.of_renders(
        tmp_path / "children.png", ROOT / "docs/images/children.png"
    )
    assert mean < 0.8
    assert worst < 16
