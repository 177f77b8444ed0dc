# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about projecting images: its example runs, its table is the operator's, and its picture
is what the operator gives."""

import re

import bpy
import numpy as np
import projection_truth as truth
import scenes
from figures import comparison, project_image
from processes import ROOT

PAGE = (ROOT / "docs/project_image.md").read_text()


def test_example_runs(capsys):
    ob = scenes.grid_with_holes()
    scenes.add_uv_map(ob, lambda p: p[:, :2] / (5, 4))
    truth.add_camera((2.5, 2, 9), (2.5, 2, 0))
    bpy.data.images.new("Checker", 8, 8).generated_type = "UV_GRID"
    exec(re.search(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL).group(1), {})
    printed = capsys.readouterr().out.splitlines()
    assert "(512, 512)" in printed
    assert "Limit Decal" in printed


def default_of(rna):
    if rna.type == "FLOAT" and rna.array_length:
        values = np.degrees(rna.default_array) if rna.unit == "ROTATION" else rna.default_array
        sign = "°" if rna.unit == "ROTATION" else ""
        return ", ".join(f"{value:g}{sign}" for value in np.round(values, 5))
    if rna.type == "BOOLEAN":
        return "on" if rna.default else "off"
    return rna.default if isinstance(rna.default, str) else f"{rna.default:g}"


def test_table_lists_the_properties_and_their_defaults():
    rows = dict(re.findall(r"^\| `(\w+)` \| *`?([^|`]*?)`? *\|", PAGE, re.MULTILINE))
    properties = bpy.ops.object.limit_project_image.get_rna_type().properties
    shown = {p.identifier: p for p in properties if not p.is_hidden and p.identifier != "rna_type"}
    assert rows == {name: default_of(rna) for name, rna in shown.items()}


def test_picture_is_what_the_operator_gives(tmp_path):
    project_image.make(tmp_path, samples=2)
    committed = ROOT / "docs/images/project_image.png"
    mean, worst = comparison.of_renders(tmp_path / "project_image.png", committed)
    assert mean < 2  # Blender 5 shades all of it a little differently
    assert worst < 16
