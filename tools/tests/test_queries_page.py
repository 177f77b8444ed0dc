# SPDX-License-Identifier: Apache-2.0
"""The examples of docs/queries.md run and find what they say."""

import re
from pathlib import Path

import numpy as np

PAGE = Path(__file__).parents[2] / "docs/queries.md"


def test_examples(sheet):
    above = np.array([[1.2, 1.7, 0.5], [1.5, 1.5, 2.0], [9.0, 9.0, 1.0]])
    known = {
        "np": np,
        **sheet,
        "points": above,
        "origins": above,
        "directions": np.tile([0.0, 0.0, -3.0], (3, 1)),
    }
    examples = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    assert examples
    for example in examples:
        exec(example, known)
    flat = above[:2] * [1, 1, 0]
    np.testing.assert_allclose(known["near"].position[:2], flat, atol=1e-12)
    np.testing.assert_allclose(known["seen"].position[:2], flat, atol=1e-12)
    np.testing.assert_allclose(known["seen"].distance[:2], [0.5, 2.0], atol=1e-12)
    assert known["seen"].face[2] == -1
    assert np.diff(known["every"].offsets).tolist() == [1, 1, 0]
