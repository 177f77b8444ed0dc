# SPDX-License-Identifier: Apache-2.0
"""Meshes in Wavefront's OBJ format."""

from pathlib import Path

import numpy as np

from figures import ROOT

#: Five quads in the shape of a cross: the control mesh of the paper's figure 1
CROSS = ROOT / "native/tests/data/cross.obj"


def read(path: Path) -> tuple[np.ndarray, list[list[int]]]:
    """Positions and faces, of a file whose faces name vertices only."""
    lines = [line.split() for line in path.read_text().splitlines() if line]
    positions = [[float(x) for x in words[1:]] for words in lines if words[0] == "v"]
    faces = [[int(i) - 1 for i in words[1:]] for words in lines if words[0] == "f"]
    return np.array(positions), faces
