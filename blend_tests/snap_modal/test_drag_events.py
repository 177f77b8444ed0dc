# SPDX-License-Identifier: GPL-3.0-or-later
"""The events of view3d.limit_snap_modal, with a stand-in for the viewport."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.snap_modal import operator as module
from limit_surface.tasks import running
from limit_surface.viewport.ray import Ray
from limit_surface.viewport.view import region_at
from stand_ins import stand_in_of, window_context

RUNNING = {"RUNNING_MODAL"}


class View:
    """Looks straight down: a pixel is a hundredth of a unit. The sidebar begins at x = 400."""

    exists = True

    def __init__(self, _context):
        self.keys = self.state = ""

    def is_over(self, event):
        return event.mouse_x < 400

    def sight(self, event):
        if not self.is_over(event):
            return None
        at = np.array([event.mouse_x / 100, event.mouse_y / 100, 10.0])
        return Ray(at, np.array([0.0, 0.0, -1.0]), False)

    def show_keys(self, text):
        self.keys = text

    def show_state(self, text):
        self.state = text

    def redraw(self):
        pass

    def clear(self):
        self.keys = self.state = ""


class Drawing:
    mark, is_shown = None, True

    def remove(self):
        assert self.is_shown
        self.is_shown = False


def event(kind, value="PRESS", at=(150, 150), **held):
    flags = dict.fromkeys(("ctrl", "alt", "oskey", "shift"), False) | held
    return SimpleNamespace(
        type=kind, value=value, mouse_x=at[0], mouse_y=at[1], unicode="", **flags
    )


@pytest.fixture
def pin():
    sheet = scenes.flat_grid(4)
    ob = bpy.data.objects.new("Pin", None)
    bpy.context.collection.objects.link(ob)
    ob.location, ob.rotation_euler = (5, 4, 3), (0.3, 0.2, 0.1)
    ob.select_set(True)
    sheet.select_set(True)
    scenes.activate(sheet)
    bpy.context.view_layer.update()
    return ob


@pytest.fixture
def drag(pin, monkeypatch):
    """Returns an operator that has dragged the pin to a place."""
    monkeypatch.setattr(module, "View", View)
    monkeypatch.setattr(module, "Drawing", Drawing)
    monkeypatch.setattr(running, "_all", [])
    operator = stand_in_of(module.VIEW3D_OT_limit_snap_modal)
    context = window_context()
    context.area = SimpleNamespace(type="VIEW_3D")
    context.evaluated_depsgraph_get = bpy.context.evaluated_depsgraph_get
    assert operator.invoke(context, event("MOUSEMOVE")) == RUNNING
    operator.take = lambda *named, **held: operator.modal(context, event(*named, **held))
    operator.take("MOUSEMOVE", at=(120, 210))
    np.testing.assert_allclose(pin.location, (1.2, 2.1, 0), atol=1e-6)
    return operator


def said(drag):
    return [call.args[1] for call in drag.report.call_args_list]


def check_nothing_is_shown(drag):
    assert not drag._drawing.is_shown
    assert drag._view.keys == drag._view.state == ""
    assert not running._all


def test_click(drag, pin):
    assert drag.take("LEFTMOUSE") == {"FINISHED"}
    np.testing.assert_allclose(pin.location, (1.2, 2.1, 0), atol=1e-6)
    check_nothing_is_shown(drag)


def test_esc(drag, pin):
    assert drag.take("ESC") == {"CANCELLED"}
    assert tuple(pin.location) == (5, 4, 3)
    check_nothing_is_shown(drag)


def test_a_click_on_the_sidebar_is_ignored(drag, pin):
    before = tuple(pin.location)
    assert drag.take("MOUSEMOVE", at=(450, 210)) == RUNNING
    assert "no surface under the mouse" in drag._view.state
    assert drag.take("LEFTMOUSE", at=(450, 210)) == RUNNING
    assert drag.take("LEFTMOUSE", "RELEASE", at=(450, 210)) == RUNNING
    assert tuple(pin.location) == before
    assert drag.take("LEFTMOUSE", at=(120, 210)) == {"FINISHED"}


@pytest.mark.parametrize("held", ["ctrl", "alt", "oskey"])
@pytest.mark.parametrize("key", ["A", "X", "Y", "Z"])
def test_keys_that_mean_something_else(drag, pin, key, held):
    before = tuple(pin.location), tuple(pin.rotation_euler), drag._glide.lock, drag.align
    assert drag.take(key, **{held: True}) == RUNNING
    assert (
        tuple(pin.location), tuple(pin.rotation_euler), drag._glide.lock, drag.align,
    ) == before  # fmt: skip
    drag.take("A")
    assert tuple(pin.rotation_euler) != before[1]


def test_disabling_the_extension(drag, pin):
    running.end_all()
    assert tuple(pin.location) == (5, 4, 3)
    check_nothing_is_shown(drag)


@pytest.mark.parametrize("kind", ["MOUSEMOVE", "LEFTMOUSE", "A"])
def test_the_object_is_removed(drag, pin, kind):
    bpy.data.objects.remove(pin)
    assert drag.take(kind) == {"CANCELLED"}
    assert said(drag) == ["Pin does not exist any more"]
    check_nothing_is_shown(drag)


def test_esc_after_the_object_was_removed(drag, pin):
    bpy.data.objects.remove(pin)
    assert drag.take("ESC") == {"CANCELLED"}
    check_nothing_is_shown(drag)


def test_a_file_is_opened_after_the_object_was_removed(drag, pin):
    bpy.data.objects.remove(pin)
    drag.cancel(bpy.context)
    check_nothing_is_shown(drag)


def test_an_unforeseen_error_leaves_nothing(drag, pin, monkeypatch):
    def fail(*_arguments):
        raise ReferenceError

    monkeypatch.setattr(type(drag._drag.handle), "put", fail)
    with pytest.raises(ReferenceError):
        drag.take("MOUSEMOVE")
    assert tuple(pin.location) == (5, 4, 3)
    check_nothing_is_shown(drag)


def test_the_viewport_is_closed(drag, pin):
    drag._view.exists = False
    assert drag.take("MOUSEMOVE") == {"CANCELLED"}
    assert said(drag) == ["The 3D viewport was closed meanwhile"]
    assert tuple(pin.location) == (5, 4, 3)
    check_nothing_is_shown(drag)


def region(kind, x, y, width, height):
    return SimpleNamespace(type=kind, x=x, y=y, width=width, height=height)


def test_regions_that_overlap_the_viewport():
    scene = region("WINDOW", 0, 0, 500, 400)
    hidden = region("UI", 499, 0, 1, 1)
    area = SimpleNamespace(
        regions=[region("HEADER", 0, 370, 500, 30), region("TOOLS", 0, 0, 50, 370), hidden, scene]
    )
    assert region_at(area, 250, 200) is scene
    assert region_at(area, 499, 0) is scene
    for beside in ((250, 380), (20, 200), (600, 200), (250, -1)):
        assert region_at(area, *beside) is None


def test_both_halves_of_a_divided_viewport():
    left, right = region("WINDOW", 0, 0, 250, 400), region("WINDOW", 250, 0, 250, 400)
    area = SimpleNamespace(regions=[left, right])
    assert (region_at(area, 100, 9), region_at(area, 300, 9)) == (left, right)
