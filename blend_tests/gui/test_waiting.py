# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work in the window: Blender goes on while points are scattered, and ESC ends it.

How soon it ends is measured by tools/bench_window.py.
"""

import numpy as np
import pytest
from session import class_name

ADD_POINTS = "object.limit_points_add"
POINTS = "Limit Points"
START = ["Camera", "Cube", "Light"]
SOME_SECONDS = 200_000  # number of points
MOST = 3_000_000  # the largest number made without confirmation, which takes about a minute
STATUS_BAR = 20  # the number of rows of pixels at the lower edge of the screen


@pytest.fixture
def scatter(blender):
    """Returns a function that starts to scatter so many points by a click."""
    blender.call("set_next", ADD_POINTS, distribution="BLUE_NOISE", amount="COUNT", count=300)
    blender.call("subdivide", "Cube")
    blender.open_tab()
    button = blender.find_button(ADD_POINTS)

    def begin(count):
        blender.call("set_next", ADD_POINTS, count=count)
        blender.click(*button)

    yield begin
    blender.call("set_next", ADD_POINTS, distribution="JITTERED", count=1000)


def test_esc_ends_it_at_once(blender, scatter):
    threads = blender.call("threads")
    scatter(MOST)
    assert blender.call("running") == [class_name(ADD_POINTS)]
    assert blender.call("objects") == START
    blender.picture("waiting")
    blender.key("Escape")
    blender.await_value([], "running")
    blender.await_value(threads, "threads")
    assert blender.call("objects") == START
    blender.call("set_next", ADD_POINTS, count=300)  # afterwards the operator can be called again
    blender.click(*blender.find_button(ADD_POINTS))
    blender.await_end(ADD_POINTS)
    assert blender.call("vertex_count", POINTS) == 300


def test_disabling_the_extension_ends_it(blender, scatter):
    threads = blender.call("threads")
    blender.move(*blender.call("view_centre"))
    before = blender.screenshot("before_waiting")[-STATUS_BAR:]
    scatter(MOST)
    assert blender.call("running") == [class_name(ADD_POINTS)]
    blender.call("keep_job")
    blender.call("disable_and_enable")
    blender.move(*blender.call("view_centre"))  # Blender forgets the operator at the next event
    assert blender.call("running") == []
    blender.await_value(threads, "threads")
    assert blender.call("kept_job_is_cancelled")  # it has not gone on to its end
    assert blender.call("objects") == START
    after = blender.screenshot("waiting_disabled")[-STATUS_BAR:]
    np.testing.assert_array_equal(after, before)


def test_points_come_when_they_are_ready(blender, scatter):
    scatter(SOME_SECONDS)
    blender.await_end(ADD_POINTS)
    assert blender.call("vertex_count", POINTS) == SOME_SECONDS
    assert blender.call("last_operator") == class_name(ADD_POINTS)
    blender.move(*blender.call("view_centre"))
    blender.key("ctrl+z")
    assert blender.call("objects") == START
