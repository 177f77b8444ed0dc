# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about snapping: its example runs, its table is the operator's."""

import re

import bpy
import numpy as np
import scenes
from processes import ROOT
from snap_scenes import add_hair, roots, world_strands
from snap_truth import Truth, stretched

PAGE = (ROOT / "docs/snap.md").read_text()


def test_example():
    scalp = stretched(scenes.cross())
    scalp.name = "Scalp"
    hair = add_hair(scalp)
    hair.name = "Brow"
    truth = Truth(scalp)
    (example,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    exec(example, {})
    distances = truth.distances(roots(world_strands(hair)))
    np.testing.assert_allclose(distances, 0.002, atol=3e-6)


def test_table_lists_the_properties_and_their_defaults():
    section = PAGE.split("## Properties")[1].split("\n## ")[0]
    rows = dict(re.findall(r"^\| `(\w+)` \| `?([^|`]+?)`? \|", section, re.MULTILINE))
    properties = bpy.ops.object.limit_snap.get_rna_type().properties
    shown = {p.identifier: p for p in properties if not p.is_hidden and p.identifier != "rna_type"}
    assert rows.keys() == shown.keys()
    for name, said in rows.items():
        prop = shown[name]
        if prop.type == "BOOLEAN":
            assert said == ("on" if prop.default else "off")
        elif prop.type == "ENUM":
            assert said == prop.default
        else:
            np.testing.assert_allclose(float(said), prop.default, rtol=1e-5)
