# SPDX-License-Identifier: Apache-2.0
"""The example of docs/strands.md moves every root with the surface, and its table is whole."""

import re
from pathlib import Path

import limitsurf as ls
import numpy as np

PROPERTIES = {"bound_count", "irregular_count", "point_count"}
PAGE = (Path(__file__).parents[2] / "docs/strands.md").read_text()


def test_the_example_moves_roots_with_the_surface(sheet):
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(**sheet))
    known = {"np": np, "surface": surface}
    (example,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    exec(example, known)
    strands = known["posed"].reshape(1000, 8, 3)
    np.testing.assert_allclose(strands[:, 0], 1.1 * known["roots"], atol=1e-6)
    lengths = np.linalg.norm(np.diff(strands, axis=1), axis=2).sum(axis=1)
    np.testing.assert_allclose(lengths, 0.1, atol=1e-5)


def test_the_table_lists_every_method():
    listed = re.findall(r"^\| `(\w+)\(", PAGE, re.MULTILINE)
    methods = [name for name in vars(ls.StrandPoser) if not name.startswith("_")]
    assert sorted(listed) == sorted(set(methods) - PROPERTIES)
