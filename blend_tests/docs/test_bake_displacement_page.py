# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about displacement: its examples run, its tables are correct, and its picture shows what
the operator makes.
"""

import json
import re

import bpy
import limitsurf
import numpy as np
import pages
import pytest
import scenes
import sculpts
from figures import comparison
from figures.displacement import picture, table
from limit_surface import ids
from processes import ROOT

PAGE = pages.text("displacement")
EXAMPLES = pages.examples(PAGE)


def test_example_in_blender(capsys):
    ob = scenes.flat_grid(3)
    scenes.add_subsurf(ob)
    scenes.add_uv_map(ob, lambda at: at[:, :2] / 4 + 0.1)
    sculpts.subdivided_copy(ob, 1)
    exec(EXAMPLES[0], {})
    assert capsys.readouterr().out.endswith("True Non-Color\n")


@pytest.mark.parametrize("example", EXAMPLES[1:])
def test_examples_without_blender(example, capsys):
    exec(example, {})
    said = re.findall(r"^print.*# (.*)$", example, re.MULTILINE)
    assert said
    assert capsys.readouterr().out.splitlines() == said


def test_table_lists_the_properties_and_their_defaults():
    pages.check_properties(PAGE, "limit_bake_displacement")


def test_table_of_errors():
    """The first two rows are checked at fewer places."""
    rows = re.findall(r"^\| (\d+) \| (.*) \|$", PAGE, re.MULTILINE)
    assert [int(size) for size, _ in rows] == list(table.SIZES)
    said = np.array([[float(number) for number in cells.split(" | ")] for _, cells in rows])
    case = table.head()
    found = [table.numbers(table.measure(case, size, 40_000))
             for size in (256, 512)]  # fmt: skip
    np.testing.assert_allclose(np.array(found)[:, 1:3], said[:2, 1:3], rtol=0.15)
    np.testing.assert_array_less(np.array(found)[:, [0, 3]], 1.1 * said[:2, [0, 3]])
    quarters = said[:-1, 1] / said[1:, 1]
    assert quarters.min() > 3.7


def test_page_tells_the_custom_property():
    ob = scenes.flat_grid(2)
    scenes.add_subsurf(ob)
    target = sculpts.subdivided_copy(ob, 1)
    bpy.ops.object.limit_bake_displacement(target=target.name, layout_kind="PTEX", space="OBJECT")
    told = json.loads(bpy.data.images["Flat Displacement"][ids.DISPLACEMENT])
    assert ids.DISPLACEMENT in PAGE
    for name in ("face_count", "resolution", "columns"):
        assert f"`{name}`" in PAGE
        assert told[name] == getattr(limitsurf.PtexLayout(4, 16), name)


@pytest.mark.slow
@pytest.mark.skipif(
    bpy.app.version >= (5, 0), reason="suns are brighter there than in the committed picture"
)
def test_picture_is_what_the_operator_gives(tmp_path):
    picture.make(tmp_path, samples=4)
    committed = ROOT / "docs/images/displacement.png"
    mean, worst = comparison.of_renders(tmp_path / "displacement.png", committed)
    assert mean < 1
    assert worst < 16


def test_tooltips_of_resolutions_count_in_words_that_fit():
    items = bpy.ops.object.limit_bake_displacement.get_rna_type().properties["face_resolution"]
    said = [item.description for item in items.enum_items][:2]
    assert said == [f"Divide each side of a face into {parts}" for parts in ("1 part", "2 parts")]
