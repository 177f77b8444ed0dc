# SPDX-License-Identifier: GPL-3.0-or-later
"""object.limit_snap by the button in the sidebar tab: it is undone, and adjusted in the redo
panel.
"""

import numpy as np
import pytest
from quadric import Sheet, boundary_height

SNAP = "object.limit_snap"
ON_SURFACE = 1e-6


@pytest.fixture
def sheet(blender):
    found = Sheet(blender.call("sheet"))
    blender.settle()
    return found


def position(blender):
    return np.array(blender.call("matrix", "Pin"))[:3, 3]


def snap(blender):
    """Selects everything by steps that can be undone, and snaps it."""
    blender.key("alt+a", "ctrl+i")
    blender.open_tab()
    blender.click(*blender.find_button(SNAP))


def corners(blender, sheet):
    """Returns the corners of the triangle in Edit Mode, in world space."""
    to_world = np.array(blender.call("matrix", "Triangle"))
    found = np.array(blender.call("vertices", "Triangle"))
    return found @ to_world[:3, :3].T + to_world[:3, 3]


def test_button_undo_and_redo(blender, sheet):
    blender.call("pin")
    before = blender.call("transform", "Pin")
    snap(blender)
    after = blender.call("transform", "Pin")
    assert abs(sheet.above(position(blender))) < ON_SURFACE
    assert after[1:] == before[1:]
    blender.move(*blender.call("view_centre"))
    blender.key("ctrl+z")
    assert blender.call("transform", "Pin") == before
    blender.key("ctrl+shift+z")
    assert blender.call("transform", "Pin") == after


@pytest.mark.slow
def test_offset_in_the_redo_panel(blender, sheet):
    """The redo panel starts from where the object was before it was snapped."""
    blender.call("pin")
    snap(blender)
    flush = position(blender)
    x, y = blender.open_redo_panel()
    _, below = blender.find_field(x, y, value="90")
    blender.move(*blender.find_field(x, below, value="0"))
    blender.key("Return", "ctrl+a", "period", "5", "Return")
    expected = flush + 0.5 * sheet.world_normal(sheet.local(flush))
    np.testing.assert_allclose(position(blender), expected, atol=ON_SURFACE)


def test_vertices_in_edit_mode(blender, sheet):
    blender.call("loose_vertices")
    before = corners(blender, sheet)
    snap(blender)
    after = corners(blender, sheet)
    assert np.linalg.norm(after - before, axis=1).min() > 0.1
    _, beyond, above = after
    assert abs(sheet.above(above)) < ON_SURFACE
    x, y, z = sheet.local(beyond)
    np.testing.assert_allclose((y, z), (0, boundary_height(x)), atol=ON_SURFACE)
    blender.move(*blender.call("view_centre"))
    blender.key("ctrl+z")
    np.testing.assert_array_equal(corners(blender, sheet), before)
