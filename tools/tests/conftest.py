# SPDX-License-Identifier: Apache-2.0
"""Fixtures that the tests of pages share. Tools and figures can be imported."""

import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "tools")]

from figures.meshes.grids import grid_faces  # noqa: E402


@pytest.fixture
def sheet() -> dict[str, np.ndarray]:
    """Returns nine flat unit squares, which the examples call `positions` and `faces`."""
    y, x = np.mgrid[:4, :4].reshape(2, -1)
    positions = np.stack([x, y, 0 * x], axis=1).astype(float)
    return {"positions": positions, "faces": grid_faces(3, 3)}
