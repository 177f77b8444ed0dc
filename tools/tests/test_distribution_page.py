# SPDX-License-Identifier: Apache-2.0
"""The Python example of docs/distribution.md runs and gives what it says."""

import re
from pathlib import Path

import numpy as np

PAGE = Path(__file__).parents[2] / "docs/distribution.md"


def test_example(sheet):
    known = {"positions": sheet["positions"] / 3, "faces": sheet["faces"]}
    section = PAGE.read_text().split("\n## In Python\n")[1]
    example, along, masked, flow = re.findall(
        r"^```python\n(.*?)^```$", section, re.MULTILINE | re.DOTALL
    )
    counts = []
    for line in example.splitlines():
        exec(line, known)
        if line.startswith("at ="):
            counts.append(len(known["at"]))
    assert counts[:2] == [100_000, 20_000]
    exec(along, known)
    spots = np.random.default_rng(1).random((32, 32, 1)) ** 20
    uvs, corners = sheet["positions"][:, :2] / 3, sheet["faces"].ravel()
    known.update(np=np, pixels=spots, uvs=uvs, corners=corners)
    exec(masked, known)
    assert len(known["at"]) == 1000
    assert known["density"](known["at"].face, known["at"].uv).min() > 0
    assert known["limits"].max() < 1.001
    exec(flow, known)
    assert np.shape(known["towards"]) == (len(known["at"]), 3)
    assert len(known["lashes"]) == 400
    assert len(known["half_way"]) == 1
    points = known["roots"].position
    assert len(points) == counts[2] > 2000
    apart = np.linalg.norm(points[:1000, None] - points[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    assert apart.min() >= 0.01
    assert known["roots"].normal.shape == (counts[2], 3)
