# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Subdivision Surface at its best quality shows the surface that we evaluate."""

import numpy as np
import parity_zoo
import pytest
from limit_surface import rules
from parity_measure import Comparison

BEST = 10
BOUND = 1e-6  # of the diagonal; Blender computes in single precision


@pytest.mark.parametrize("boundary", rules.BOUNDARIES)
@pytest.mark.parametrize("name", parity_zoo.MESHES)
def test_smooth_meshes(name, boundary):
    ob = parity_zoo.add(name)
    ob.modifiers[0].boundary_smooth = boundary
    found = Comparison(ob, levels=3)
    distance = found.positions(BEST)
    assert np.count_nonzero(np.isnan(distance)) == (1 if name == "fans" else 0)  # isolated
    assert np.nanmax(distance) <= BOUND
    # That is not because nothing could be seen:
    assert np.nanmax(found.positions(1)) > 1e-3
