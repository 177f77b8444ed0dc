# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the sidebar: they are drawn when something has changed, and only then."""

import pytest
from session import ROW, wait_until

DRAW = "view3d.limit_draw"  # the last button above the panels Hair, Points and Draw
HEADER = 1.4 * ROW  # from one closed panel to the next
SOON = 100  # rounds of the main loop, at least 0.5 s
LONG = 400  # and at least 2 s


def open_hair(blender, below=0):
    x, y = blender.find_button(DRAW)
    blender.click(x, y - 1.7 * ROW - below)


def open_points(blender):
    open_hair(blender, below=HEADER)


def open_draw(blender):
    open_hair(blender, 2 * HEADER)


def open_follow(blender):
    blender.open_panel("VIEW3D_PT_limit_follow")


@pytest.mark.parametrize(
    ("panel", "show"),
    [
        ("VIEW3D_PT_limit_hair", open_hair),
        ("VIEW3D_PT_limit_points", open_points),
        ("VIEW3D_PT_limit_draw", open_draw),
        ("VIEW3D_PT_limit_follow", open_follow),
    ],
)
def test_an_open_panel_comes_to_rest(blender, panel, show):
    def draws(rounds):
        before = blender.call("draws", panel)
        blender.call("settle", rounds)
        return blender.call("draws", panel) - before

    blender.call("subdivide", "Cube")
    blender.call("hair", 5)
    blender.open_tab()
    blender.call("count_draws", panel)
    show(blender)
    assert blender.call("draws", panel) > 0
    blender.move(*blender.call("view_centre"))
    wait_until(lambda: draws(SOON) == 0, f"{panel} is not drawn any more")
    assert draws(LONG) == 0
    blender.screenshot(panel)


def test_the_numbers_of_a_report_fit_the_sidebar(blender):
    blender.call("subdivide", "Cube")
    blender.call("report")
    blender.open_tab()
    blender.open_panel("VIEW3D_PT_limit_report")
    blender.screenshot("report_panel")
