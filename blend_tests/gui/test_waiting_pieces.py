# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work on Blender's own data in the window, which is done piece by piece: ESC between two
pieces ends it, and nothing has changed.
"""

import pytest
from session import class_name

FOLLOW, LAY = "object.limit_follow", "object.limit_curve_lay"
#: What takes some seconds, and what takes a moment
MANY = {FOLLOW: 1_000_000, LAY: 1000}
FEW = {FOLLOW: 20, LAY: 2}


@pytest.mark.parametrize("operator", MANY)
def test_esc_ends_it_and_nothing_has_changed(blender, operator):
    things = {FOLLOW: "points_above_sheet", LAY: "lines_above_sheet"}[operator]
    blender.call(things, MANY[operator])
    threads, before = blender.call("threads"), blender.call("parts_of_file")
    blender.call("remember_and_start", operator)
    assert blender.call("running") == [class_name(operator)]
    blender.key("Escape")
    blender.await_value([], "running")
    blender.await_value(threads, "threads")
    assert blender.call("parts_of_file") == before
    blender.call(things, FEW[operator])  # afterwards the operator can be called again
    before = blender.call("parts_of_file")
    blender.call("remember_and_start", operator)
    blender.await_value([], "running")
    assert blender.call("parts_of_file") != before
