# SPDX-License-Identifier: Apache-2.0
"""The example of docs/tiles.md gives the surface's positions, and the page's tables are whole."""

import re
from pathlib import Path

import limitsurf as ls
import numpy as np

PAGE = (Path(__file__).parents[2] / "docs/tiles.md").read_text()


def test_the_example_gives_the_positions_of_the_surface(sheet):
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(**sheet))
    known = {"np": np, "surface": surface, "at": surface.scatter_jittered(9, seed=1)}
    (example,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    exec(example, known)
    at = known["at"]
    assert not known["tiles"].moved.any()
    expected = 2 * surface.evaluate(at.face, at.uv).position
    np.testing.assert_allclose(known["moved"], expected, rtol=0, atol=1e-13)


def test_the_table_lists_every_field():
    rows = re.findall(r"^\| (`.*?`) \|", PAGE, re.MULTILINE)
    listed = [name for row in rows for name in re.findall(r"`(\w+)`", row)]
    fields = [*ls.Tiles.__dataclass_fields__, *ls.TileQuadtree.__dataclass_fields__]
    assert listed == fields
