# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about snapping: its example runs, and its table matches the operator."""

import numpy as np
import pages
import scenes
from snap_scenes import add_hair, roots, world_strands
from snap_truth import Truth, stretched

PAGE = pages.text("snap")


def test_example():
    scalp = stretched(scenes.cross())
    scalp.name = "Scalp"
    hair = add_hair(scalp)
    hair.name = "Brow"
    truth = Truth(scalp)
    (example,) = pages.examples(PAGE)
    exec(example, {})
    distances = truth.distances(roots(world_strands(hair)))
    np.testing.assert_allclose(distances, 0.002, atol=3e-6)


def test_table_lists_the_properties_and_their_defaults():
    pages.check_properties(PAGE.split("## Properties")[1].split("\n## ")[0], "limit_snap")
