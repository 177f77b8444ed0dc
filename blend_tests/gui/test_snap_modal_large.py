# SPDX-License-Identifier: GPL-3.0-or-later
"""Dragging follows each move, whatever the size of the target. Its speed is measured by
tools/bench_window.py.
"""

import drags
import numpy as np
import pytest
from quadric import Camera


@pytest.mark.slow
def test_moves_on_a_hundred_thousand_faces(blender):
    # A move takes seconds where the screen is drawn without a graphics card.
    moves = drags.drag_over_large_sheet(blender, free=10, constrained=4)
    assert len(moves.free) == 10
    assert len(moves.border) == len(moves.boundary) == 5
    found = np.array(blender.call("matrix", "Pin"))[:3, 3]
    assert np.abs(found[:2]).max() == pytest.approx(4, abs=1e-6)  # on the boundary
    blender.key("z")
    at = 450, 400
    blender.move(*at)
    found = np.array(blender.call("matrix", "Pin"))[:3, 3]
    assert found[2] == pytest.approx(0.2 * np.sin(3 * found[0]) * np.cos(2 * found[1]), abs=1e-3)
    shown = Camera(**blender.call("camera")).pixel(found)
    np.testing.assert_allclose(shown, at, atol=0.1)
    blender.key("Return")
    assert not blender.call("running")
