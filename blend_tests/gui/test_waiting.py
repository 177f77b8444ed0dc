# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work in the window: Blender goes on while points are scattered, and ESC ends it."""

import time

import pytest

ADD_POINTS = "object.limit_points_add"
POINTS = "Limit Points"
START = ["Camera", "Cube", "Light"]
SOME_SECONDS = 400_000  # points


@pytest.fixture
def waiting(blender):
    """Points by a click, that are not there yet."""
    blender.call("set_next", ADD_POINTS, distribution="BLUE_NOISE", amount="COUNT", count=300)
    blender.open_tab()
    button = blender.find_button(ADD_POINTS)
    blender.call("set_next", ADD_POINTS, count=SOME_SECONDS)
    blender.click(*button)
    assert blender.call("objects") == START
    yield blender
    blender.call("set_next", ADD_POINTS, distribution="JITTERED", count=1000)


def test_esc_ends_it_at_once(waiting):
    waiting.screenshot("waiting")
    waiting.key("Escape")
    asked = time.monotonic()
    waiting.call("redraw")
    assert time.monotonic() - asked < 2
    for _ in range(20):
        time.sleep(0.2)
        assert waiting.call("objects") == START
    waiting.call("set_next", ADD_POINTS, count=300)  # and then it can be called again
    waiting.click(*waiting.find_button(ADD_POINTS))
    assert waiting.call("vertex_count", POINTS) == 300


def test_points_come_when_they_are_ready(waiting):
    deadline = time.monotonic() + 90
    while POINTS not in waiting.call("objects"):
        assert time.monotonic() < deadline
        time.sleep(0.2)
    assert waiting.call("vertex_count", POINTS) == SOME_SECONDS
    assert waiting.call("last_operator") == "OBJECT_OT_limit_points_add"
    waiting.move(*waiting.call("view_centre"))
    waiting.key("ctrl+z")
    assert waiting.call("objects") == START
