# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets in the window: in the sidebar and in the redo panel."""

import pytest
from session import ROW

ADD_HAIR = "object.limit_hair_add"
DRAW = "view3d.limit_draw"  # the last button above the panel
HAIR = "Limit Hair"


@pytest.fixture
def open_presets(blender):
    """Returns a function that opens the menu of presets in the sidebar, in the panel Hair, which it
    opens at first.
    """
    blender.call("subdivide", "Cube")
    blender.open_tab()
    x, y = blender.find_button(DRAW)
    header = y - 1.7 * ROW  # y is between the button's upper border and a quarter of its height
    blender.click(x, header)
    yield lambda: blender.click(x, header - 1.55 * ROW)
    blender.click(x, header)
    names = ("distribution", "count", "length", "points", "random", "radius")
    defaults = ("JITTERED", 1000, 0.1, 5, 0, 0.001)
    blender.call("set_next", ADD_HAIR, **dict(zip(names, defaults, strict=True)))


@pytest.mark.slow
def test_a_preset_of_the_sidebar_is_for_the_next_run(blender, open_presets):
    open_presets()
    blender.screenshot("presets_menu")
    blender.choose_in_menu("Short_Fur.py")
    count, length = blender.call("next_settings", ADD_HAIR, "count", "length")
    assert (count, round(length, 6)) == (20_000, 0.07)
    blender.screenshot("presets_chosen")
    blender.click(*blender.find_button(ADD_HAIR))
    blender.await_end(ADD_HAIR)
    assert blender.call("curve_count", HAIR) == 20_000


@pytest.mark.slow
def test_a_preset_of_the_redo_panel_makes_it_anew(blender, open_presets):
    blender.click(*blender.find_button(ADD_HAIR))
    blender.await_end(ADD_HAIR)
    blender.open_redo_panel()
    blender.choose_in_menu("WM_MT_operator_presets")
    blender.choose_in_menu("Grass.py")
    blender.screenshot("presets_redone")
    blender.await_value(20_000, "curve_count", HAIR)
