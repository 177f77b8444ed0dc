# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about the extension: its examples run, its table is the operator's."""

import re

import bpy
import numpy as np
import scenes
from processes import ROOT

PAGE = (ROOT / "docs/blender.md").read_text()


def test_examples_give_the_roots():
    scenes.cross()
    known = {}
    for example in re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL):
        exec(example, known)
    np.testing.assert_array_equal(
        known["roots"].astype(np.float32), scenes.strands(known["hair"])[:, 0]
    )


def test_table_lists_the_properties_and_their_defaults():
    section = PAGE.split("`object.limit_hair_add`", 2)[1].split("\n## ")[0]
    rows = dict(re.findall(r"^\| `(\w+)` \| `?([^|`]+?)`? \|", section, re.MULTILINE))
    properties = bpy.ops.object.limit_hair_add.get_rna_type().properties
    shown = {p.identifier: p for p in properties if not p.is_hidden and p.identifier != "rna_type"}
    assert set(rows) == set(shown)
    for name, said in rows.items():
        prop = shown[name]
        if prop.type == "BOOLEAN":
            assert said == ("on" if prop.default else "off")
        elif prop.type == "STRING" or (prop.type == "ENUM" and prop.is_enum_flag):
            assert said == "none"
            assert not prop.default
        elif prop.type == "ENUM":
            assert said == prop.default
        elif prop.is_array:
            np.testing.assert_allclose([float(x) for x in said.split(",")], prop.default_array[:])
        else:
            np.testing.assert_allclose(float(said), prop.default, rtol=1e-6)
