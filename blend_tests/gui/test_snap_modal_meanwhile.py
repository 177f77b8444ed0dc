# SPDX-License-Identifier: GPL-3.0-or-later
"""What happens to a drag in the window while somebody changes the scene, the window or the
extension; and clicks and keys that are not meant for it.
"""

import numpy as np
import pytest
from quadric import Camera, Sheet, height
from session import class_name

ON_SURFACE = 1e-6
DRAG = class_name("view3d.limit_snap_modal")
ROUNDED = 2  # the largest difference of a color where the same is drawn anew


@pytest.fixture
def sheet(blender, sheet):
    blender.call("pin")
    blender.settle()
    return sheet


def position(blender, name="Pin"):
    return np.array(blender.call("matrix", name))[:3, 3]


@pytest.fixture
def unmarked(blender, sheet, seen):
    """Returns a function that checks that the screen looks as before the drag."""
    blender.move(*seen(3.2, 2.2))
    before = blender.screenshot("before_drag")

    def check(name):
        blender.move(*seen(3.2, 2.2))
        after = blender.screenshot(name)
        np.testing.assert_allclose(after.astype(int), before, atol=ROUNDED)

    return check


@pytest.mark.parametrize("change", ["bend_sheet", "move_sheet"])
def test_put_on_the_surface_as_it_is_by_now(blender, sheet, seen, change):
    blender.call("animate_sheet")
    blender.call("start_drag")
    blender.move(*seen(3.2, 2.2))
    before = position(blender)
    assert abs(sheet.above(before)) < ON_SURFACE
    blender.call("go_to_frame", 20 if change == "bend_sheet" else 40)
    blender.press()
    assert not blender.call("running")
    assert blender.call("last_operator") == DRAG
    at = position(blender)
    assert np.linalg.norm(at - before) > 0.3
    now = Sheet(blender.call("matrix", "Sheet"))
    bent = 0.5 if change == "bend_sheet" else 0.0
    x, y, z = now.local(at)
    assert abs(z - bent - height(x, y)) < ON_SURFACE
    np.testing.assert_allclose([x, y], sheet.local(before)[:2], atol=1e-5)


@pytest.mark.parametrize("change", ["remove", "undo"])
def test_the_object_is_changed_in_another_window(blender, sheet, seen, change):
    blender.call("move_pin_after_a_step")
    blender.call("start_drag")
    blender.move(*seen(2.3, 1.4))
    assert blender.call("running")
    blender.call("in_another_window", change)
    blender.move(*seen(2.4, 1.5))
    assert not blender.call("running")
    assert blender.call("objects") == (["Sheet"] if change == "remove" else ["Pin", "Sheet"])
    blender.screenshot(f"drag_{change}")
    assert "Traceback" not in blender.log()


def test_edit_mode_is_left_in_another_window(blender, sheet, seen):
    blender.call("loose_vertices")
    before = blender.call("points", "Triangle")
    blender.call("start_drag")
    matrix = np.array(blender.call("matrix", "Triangle"))
    camera = Camera(**blender.call("camera"))
    blender.click(*camera.pixel(matrix[:3, :3] @ before[1] + matrix[:3, 3]))
    blender.move(*seen(4.1, 2.4))
    assert blender.call("vertices", "Triangle") != before
    blender.call("in_another_window", "leave_edit_mode")
    blender.move(*seen(4.0, 2.3))
    assert not blender.call("running")
    blender.screenshot("drag_edit_mode_left")
    assert blender.call("points", "Triangle") == before
    assert "Traceback" not in blender.log()


def test_disabled_while_something_is_dragged(blender, sheet, seen, unmarked):
    before = blender.call("transform", "Pin")
    blender.call("start_drag", align="NORMAL")
    blender.move(*seen(2.3, 1.4))
    assert blender.call("transform", "Pin") != before
    blender.call("disable_and_enable")
    blender.move(*seen(2.4, 1.5))  # Blender forgets the operator at the next event
    assert not blender.call("running")
    assert blender.call("transform", "Pin") == before
    unmarked("drag_disabled")


def test_disabled_while_somebody_draws(blender, sheet, seen, unmarked):
    blender.call("start_drawing")
    blender.stroke([seen(2.3, 1.4), seen(3, 2), seen(3.5, 2.5)])
    blender.call("disable_and_enable")
    blender.move(*seen(2.4, 1.5))  # Blender forgets the operator at the next event
    assert not blender.call("running")
    unmarked("drawing_disabled")


def test_clicks_on_the_sidebar_and_the_header_do_not_confirm(blender, sheet, seen):
    blender.call("show_sidebar")
    blender.settle()
    blender.call("start_drag")
    blender.move(*seen(3.2, 2.2))
    before = position(blender)
    for kind in ("UI", "TOOLS", "HEADER", "TOOL_HEADER"):
        blender.click(*blender.call("middle_of", kind))
        assert blender.call("running") == [DRAG]
        np.testing.assert_array_equal(position(blender), before)
    blender.click(*seen(3.2, 2.2))
    assert not blender.call("running")
    assert blender.call("last_operator") == DRAG


def test_keys_with_ctrl_and_alt_mean_something_else(blender, sheet, seen):
    blender.call("start_drag")
    blender.move(*seen(3.2, 2.45))
    before = np.array(blender.call("matrix", "Pin"))
    for key in ("ctrl+a", "alt+a", "ctrl+x", "ctrl+y", "super+a", "ctrl+z"):
        blender.key(key)
        assert blender.call("running") == [DRAG]
        np.testing.assert_array_equal(np.array(blender.call("matrix", "Pin")), before)
    blender.key("x")
    assert not np.array_equal(np.array(blender.call("matrix", "Pin")), before)
    blender.key("Escape")


def test_another_workspace_is_shown_meanwhile(blender, sheet, seen, unmarked):
    blender.call("start_drag")
    blender.move(*seen(2.3, 1.4))
    blender.call("show_workspace", "Modeling")
    blender.settle()
    blender.picture("drag_in_another_workspace")
    blender.key("Escape")
    assert not blender.call("running")
    blender.call("show_workspace", "Layout")
    blender.settle()
    unmarked("drag_another_workspace")
