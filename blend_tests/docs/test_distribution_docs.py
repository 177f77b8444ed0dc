# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about distributions: its examples run one after the other."""

import bpy
import numpy as np
import pages
import pytest
from figures import border, comparison, steering
from limit_surface import ids
from processes import ROOT
from scenes import locations, strands

PAGE = pages.text("distribution").split("\n## In Python\n")[0]


def test_examples_run():
    known, made = {}, []
    for example in pages.examples(PAGE):
        exec(example, known)
        made.append(bpy.context.active_object)
    hair, lashes, steered, combed, points = made
    assert len(lashes.data.curves) == 400
    assert len(hair.data.curves) > 500
    assert ids.REST_ROOT in hair.data.attributes
    lengths = np.linalg.norm(strands(steered)[:, -1] - strands(steered)[:, 0], axis=1)
    assert lengths.min() == pytest.approx(0.06, rel=0.05)
    assert lengths.max() == pytest.approx(0.2, rel=1e-4)
    points_of = strands(combed)
    (x, y, _), lean = points_of[:, 0].T, (points_of[:, -1] - points_of[:, 0])[:, :2]
    sideways = np.stack([-y, x], axis=1)
    turn = np.einsum("ni,ni->n", lean, sideways)
    assert (turn > 0.99 * np.linalg.norm(lean, axis=1) * np.linalg.norm(sideways, axis=1)).all()
    assert len(points.data.vertices) == 500
    assert not (np.unique(locations(points.data)[0]) % 2).any()


@pytest.mark.slow
@pytest.mark.skipif(
    bpy.app.version >= (5, 0), reason="suns are brighter there than in the committed picture"
)
def test_picture_of_borders_is_what_the_operators_give(tmp_path):
    border.make(tmp_path, samples=2)
    mean, worst = comparison.of_renders(tmp_path / "border.png", ROOT / "docs/images/border.png")
    assert mean < 1
    assert worst < 16


def test_every_choice_is_named():
    properties = bpy.ops.object.limit_hair_add.get_rna_type().properties
    names = ("amount", "density_source", "flow_source", "faces", "target", "border", "direction")
    for name in names:
        for choice in properties[name].enum_items.keys()[1:]:
            assert f"`{choice}`" in PAGE, choice


@pytest.mark.skipif(
    bpy.app.version >= (5, 0), reason="suns are brighter there than in the committed pictures"
)
@pytest.mark.slow
@pytest.mark.parametrize("name", ["steering", "hair_nodes"])
def test_pictures_of_strands_are_what_the_operator_gives(name, tmp_path):
    getattr(steering, f"make_{name}")(tmp_path, samples=4)
    mean, worst = comparison.of_renders(tmp_path / f"{name}.png", ROOT / f"docs/images/{name}.png")
    assert mean < 1.5
    assert worst < 24
