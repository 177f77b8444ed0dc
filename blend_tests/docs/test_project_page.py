# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about projecting images: its example runs, its table matches the operator, and its
picture shows what the operator makes.
"""

import bpy
import pages
import projection_truth as truth
import pytest
import scenes
from figures import comparison, project_image
from processes import ROOT

PAGE = pages.text("project_image")


def test_example_runs(capsys):
    ob = scenes.grid_with_holes()
    scenes.add_uv_map(ob, lambda p: p[:, :2] / (5, 4))
    truth.add_camera((2.5, 2, 9), (2.5, 2, 0))
    bpy.data.images.new("Checker", 8, 8).generated_type = "UV_GRID"
    exec(pages.examples(PAGE)[0], {})
    printed = capsys.readouterr().out.splitlines()
    assert "(512, 512)" in printed
    assert "Limit Decal" in printed


def test_table_lists_the_properties_and_their_defaults():
    pages.check_properties(PAGE, "limit_project_image", empty="")


@pytest.mark.slow
def test_picture_is_what_the_operator_gives(tmp_path):
    project_image.make(tmp_path, samples=2)
    committed = ROOT / "docs/images/project_image.png"
    mean, worst = comparison.of_renders(tmp_path / "project_image.png", committed)
    assert mean < 2  # Blender 5 shades the whole picture slightly differently
    assert worst < 16
