# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about the extension: its examples run, and its table matches the operator."""

import numpy as np
import pages
import scenes

PAGE = pages.text("blender")


def test_examples_give_the_roots():
    scenes.cross()
    known = {}
    for example in pages.examples(PAGE):
        exec(example, known)
    np.testing.assert_array_equal(
        known["roots"].astype(np.float32), scenes.strands(known["hair"])[:, 0]
    )


def test_table_lists_the_properties_and_their_defaults():
    pages.check_properties(
        PAGE.split("`object.limit_hair_add`", 2)[1].split("\n## ")[0], "limit_hair_add"
    )
