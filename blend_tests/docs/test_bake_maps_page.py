# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about maps: its examples run, its tables are the operator's, and its picture is what the
operator gives."""

import re

import bpy
import pytest
from figures import bake_maps, comparison
from limit_surface.bake_maps.maps import KINDS
from processes import ROOT

PAGE = (ROOT / "docs/bake_maps.md").read_text()
PICTURE = ROOT / "docs/images/bake_maps.png"
EXAMPLES = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


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
    section = PAGE.split("## The maps")[0]
    rows = {}
    for names, said in re.findall(r"^\| (`[^|]+`) \| `?([^|`]+?)`? \|", section, re.MULTILINE):
        rows |= dict.fromkeys(re.findall(r"`(\w+)`", names), said)
    properties = bpy.ops.object.limit_bake_maps.get_rna_type().properties
    shown = {p.identifier: p for p in properties if not p.is_hidden and p.identifier != "rna_type"}
    assert set(rows) == set(shown)
    for name, said in rows.items():
        prop = shown[name]
        if getattr(prop, "is_enum_flag", False):
            assert {said} == prop.default_flag
        elif isinstance(prop.default, bool):
            assert said == ("on" if prop.default else "off")
        elif isinstance(prop.default, str):
            assert said == (prop.default or "none")
        else:
            assert said == f"{prop.default:g}"


def test_table_lists_the_maps():
    section = PAGE.split("## The maps")[1].split("\n## ")[0]
    rows = re.findall(r"^\| (`[^|]+`) \| ([^|]+?) \|", section, re.MULTILINE)
    listed = {}
    for keys, names in rows[1:] if rows[0][0] == "`maps`" else rows:
        listed |= zip(re.findall(r"`(\w+)`", keys), names.split(", "), strict=True)
    assert listed == {key: kind.name for key, kind in KINDS.items()}


@pytest.mark.skipif(
    bpy.app.version >= (5, 0), reason="suns are brighter there than in the committed picture"
)
def test_picture_is_what_the_operator_gives(tmp_path):
    bake_maps.make(tmp_path, samples=4)
    mean, worst = comparison.of_renders(tmp_path / "bake_maps.png", PICTURE)
    assert mean < 0.7
    assert worst < 40  # shadows' edges, seen by few samples; with a wrong map it is 125
