# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that show nothing are written, and named."""

import bpy
import pytest
import scenes
from bakes import bake, geometry_tree

FORMS = ["npz", "abc", "usd", "usda"]
REMARK = "1 written; Hair shows no points: its file is empty"


@pytest.fixture
def sheet():
    sheet = scenes.flat_grid(4)
    scenes.add_subsurf(sheet)
    return sheet


def add(data):
    ob = bpy.data.objects.new("Hair", data)
    bpy.context.collection.objects.link(ob)
    return ob


@pytest.mark.parametrize("form", FORMS)
def test_hair_without_strands(sheet, tmp_path, capfd, form):
    curves = bpy.data.hair_curves.new("Hair")
    curves.surface = sheet
    add(curves)
    assert bake(tmp_path, "Hair", frames="1", options=("--format", form)) == 0
    assert REMARK in capfd.readouterr().out


@pytest.mark.parametrize("form", FORMS)
def test_what_a_modifier_empties_in_some_frames(sheet, tmp_path, capfd, form):
    """Renders and the viewport are empty in frames of their own."""
    sheet.name = "Hair"
    mask = sheet.modifiers.new("Mask", "MASK")
    mask.vertex_group = sheet.vertex_groups.new(name="None").name
    for shown, frame in (("show_viewport", 1), ("show_render", 2)):
        for each in (1, 2):
            setattr(mask, shown, each == frame)
            mask.keyframe_insert(shown, frame=each)
    assert bake(tmp_path, "Hair", frames="1-2", options=("--format", form)) == 0
    lines = [line for line in capfd.readouterr().out.splitlines() if "shows no points" in line]
    (line,) = lines
    assert REMARK in line
    assert f"frame {1 if form == 'npz' else 2} " in line


@pytest.mark.parametrize("form", ["abc", "usd"])
def test_hair_that_nodes_make_a_mesh_is_not_empty(sheet, tmp_path, capfd, form):
    hair = scenes.add_hair(sheet, per_side=1, follow="NONE")
    hair.name = "Hair"
    tree, begin, end = geometry_tree("Mesh")
    mesh = tree.nodes.new("GeometryNodeCurveToMesh")
    tree.links.new(begin.outputs[0], mesh.inputs[0])
    tree.links.new(mesh.outputs[0], end.inputs[0])
    hair.modifiers.new("Mesh", "NODES").node_group = tree
    assert bake(tmp_path, "Hair", frames="1", options=("--format", form)) == 0
    assert "shows no points" not in capfd.readouterr().out
