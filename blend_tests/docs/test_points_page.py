# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about points: its example runs, and its table matches the operator."""

import bpy
import pages
import pytest
import scenes
from figures import comparison, points
from limit_surface.placing.follow_properties import FollowOrLiveProperties
from processes import ROOT

PAGE = pages.text("points")


def test_example_runs():
    ob = scenes.cross()
    plants = bpy.data.collections.new("Plants")
    for name in ("Fern", "Moss"):
        plants.objects.link(bpy.data.objects.new(name, bpy.data.meshes.new(name)))
    ob.vertex_groups.new(name="Watered").add(range(6), 1.0, "REPLACE")
    for example in pages.examples(PAGE):
        exec(example, {})
    assert len(bpy.context.active_object.data.vertices) == 400


def test_table_lists_the_properties_and_their_defaults():
    table = PAGE.split("## Properties")[1].split("\n## ")[0]
    own = set(bpy.ops.object.limit_points_add.get_rna_type().properties.keys())
    own -= set(bpy.ops.object.limit_children_add.get_rna_type().properties.keys())
    assert not own & set(FollowOrLiveProperties.__annotations__)
    pages.check_properties(table, "limit_points_add", only=own)


@pytest.mark.slow
def test_picture_is_what_the_operator_makes(tmp_path):
    points.make(tmp_path, samples=4)
    mean, worst = comparison.of_renders(tmp_path / "points.png", ROOT / "docs/images/points.png")
    assert mean < 0.8
    assert worst < 16
