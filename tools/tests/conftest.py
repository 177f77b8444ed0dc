# SPDX-License-Identifier: Apache-2.0
"""What the tests of pages share; the programs that draw figures become importable."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs"))

from figures.meshes.grids import grid_faces  # noqa: E402


@pytest.fixture
def sheet() -> dict[str, np.ndarray]:
    """Nine flat unit squares: what the examples call `positions` and `faces`."""
    y, x = np.mgrid[:4, :4].reshape(2, -1)
    positions = np.stack([x, y, 0 * x], axis=1).astype(float)
    return {"positions": positions, "faces": grid_faces(3, 3)}
