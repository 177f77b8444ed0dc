# SPDX-License-Identifier: GPL-3.0-or-later
"""view3d.limit_draw with real mouse and keys."""

import drags
import numpy as np
import pytest
from quadric import Camera, Sheet
from session import is_near

TOLERANCE = 1e-3
ON_SURFACE = TOLERANCE + 2e-6  # and the error of Blender's single precision
NAME = "Limit Drawing"
SIZE = np.array([6.0, 5.0])  # of the sheet
#: Half a pixel at the distance of the sheet, and what steadying straightens
PIXELS = 3.0
STROKE, PEN = (38, 217, 255), (255, 204, 26)


def start(blender, **properties):
    blender.call("start_drawing", **{"tolerance": TOLERANCE} | properties)


def along(seen, places, count=12):
    """Pixels along a polyline of local places."""
    t = np.linspace(0, len(places) - 1, count)
    x, y = (np.interp(t, range(len(places)), [place[i] for place in places]) for i in (0, 1))
    return [seen(a, b) for a, b in zip(x, y, strict=True)]


def splines(blender, name=NAME):
    return blender.call("splines", name)


def assert_on_sheet(blender, sheet, name=NAME):
    for point in blender.call("drawn_points", name):
        assert abs(sheet.above(np.array(point))) < ON_SURFACE


LINE = ((1.5, 1.5), (2.5, 2.5), (4.2, 2.2))
OTHER = ((1.6, 3.2), (3.8, 3.4))


def test_stroke_lies_on_the_surface_under_the_mouse(blender, sheet, seen):
    start(blender)
    pixels = along(seen, LINE)
    blender.stroke(pixels)
    assert blender.call("running")
    assert blender.call("objects") == ["Sheet"]  # nothing is made before it is confirmed
    blender.key("Return")
    assert not blender.call("running")
    (spline,) = splines(blender)
    assert not spline["closed"]
    assert_on_sheet(blender, sheet)
    camera = Camera(**blender.call("camera"))
    ends = [camera.pixel(np.array(spline["points"][i])) for i in (0, -1)]
    np.testing.assert_allclose(ends, [pixels[0], pixels[-1]], atol=0.1)
    drawn = np.array([camera.pixel(np.array(p)) for p in blender.call("drawn_points", NAME)])
    for pixel in pixels[1:-1]:
        assert distance(pixel, drawn) < 2 * PIXELS
    blender.key("ctrl+z")
    assert blender.call("objects") == ["Sheet"]
    blender.key("ctrl+shift+z")
    assert blender.call("objects") == [NAME, "Sheet"]


def distance(pixel, polyline):
    a, b = polyline[:-1], polyline[1:]
    t = np.einsum("ij,ij->i", pixel - a, b - a) / np.einsum("ij,ij->i", b - a, b - a)
    return np.linalg.norm(a + np.clip(t, 0, 1)[:, None] * (b - a) - pixel, axis=1).min()


@pytest.mark.parametrize("leave", ["Escape", pytest.param("right button", marks=pytest.mark.slow)])
def test_cancel_leaves_everything(blender, sheet, seen, leave):
    there = blender.call("contents")
    start(blender)
    blender.stroke(along(seen, LINE))
    for is_left in (False, True):  # the first asks
        blender.key("Escape") if leave == "Escape" else blender.press(3)
        assert (blender.call("running") == []) == is_left
    assert blender.call("contents") == there


def test_several_strokes_and_taking_back(blender, sheet, seen):
    start(blender)
    blender.stroke(along(seen, LINE))
    blender.stroke(along(seen, OTHER))
    blender.key("ctrl+z")
    blender.stroke(along(seen, ((4.5, 1.2), (4.6, 3.5))))
    blender.key("ctrl+z", "ctrl+shift+z", "Return")
    found = [sheet.local(np.array(spline["points"][0])) for spline in splines(blender)]
    np.testing.assert_allclose([p[:2] for p in found], [(1.5, 1.5), (4.5, 1.2)], atol=0.02)


def test_erasing_divides_a_stroke(blender, sheet, seen):
    start(blender, brush=20)
    blender.stroke(along(seen, OTHER))
    middle = seen(2.7, 3.3)
    blender.stroke([middle, middle + [1, 0]], held="ctrl")
    blender.key("Return")
    first, second = splines(blender)
    camera = Camera(**blender.call("camera"))
    for spline in (first, second):
        for point in spline["points"]:
            assert np.linalg.norm(camera.pixel(np.array(point)) - middle) > 12
    assert_on_sheet(blender, sheet)


@pytest.mark.slow
def test_smoothing_straightens_a_stroke(blender, sheet, seen):
    bumpy = [(1.5 + 0.15 * i, 2.5 + (0.12 if i % 2 else 0)) for i in range(18)]
    start(blender, steadying=0, brush=60)
    blender.stroke([seen(*place) for place in bumpy])
    blender.key("Return")
    before = length(blender)
    blender.key("ctrl+z")
    start(blender, steadying=0, brush=60)
    blender.stroke([seen(*place) for place in bumpy])
    path = along(seen, [(1.6, 2.56), (4, 2.56)], 8)
    for _ in range(3):
        blender.stroke(path, held="shift")
    blender.key("Return")
    assert length(blender) < 0.93 * before
    assert_on_sheet(blender, sheet)


def length(blender):
    points = np.array(blender.call("drawn_points", NAME))
    return np.linalg.norm(np.diff(points, axis=0), axis=1).sum()


def test_stroke_is_continued_and_closed(blender, sheet, seen):
    corners = [(1.5, 1.5), (4, 1.5), (4, 3.5), (1.5, 3.5)]
    start(blender)
    blender.stroke(along(seen, corners[:3]))
    blender.stroke(along(seen, [*corners[2:], corners[0]]))
    blender.key("Return")
    (spline,) = splines(blender)
    assert spline["closed"]
    assert_on_sheet(blender, sheet)


@pytest.mark.slow
def test_strokes_that_meet_stay_apart_without_join(blender, sheet, seen):
    start(blender)
    blender.key("j")
    blender.stroke(along(seen, LINE))
    blender.stroke(along(seen, (LINE[-1], (4.4, 3.4))))
    blender.key("Return")
    assert len(splines(blender)) == 2


@pytest.mark.slow
def test_an_existing_drawing_is_continued(blender, sheet, seen):
    start(blender)
    blender.stroke(along(seen, LINE))
    blender.stroke(along(seen, OTHER))
    blender.key("Return")
    before = splines(blender)
    start(blender)
    blender.stroke(along(seen, (LINE[-1], (4.4, 3.4))))
    blender.key("Return")
    assert blender.call("objects") == [NAME, "Sheet"]
    kept, longer = splines(blender)
    assert kept == before[1]
    np.testing.assert_allclose(longer["points"][0], before[0]["points"][0], atol=ON_SURFACE)
    end = sheet.local(np.array(longer["points"][-1]))
    np.testing.assert_allclose(end[:2], (4.4, 3.4), atol=0.02)
    blender.key("ctrl+z")
    assert splines(blender) == before
    start(blender)
    blender.stroke(along(seen, OTHER), held="ctrl")
    blender.key("Escape", "Escape")
    assert splines(blender) == before


def test_mirrored_strokes(blender):
    blender.call("symmetric_sheet")
    blender.settle()
    x, y = blender.call("view_centre")
    start(blender)
    blender.key("x")
    blender.stroke([(x + 60 + 8 * i, y + 10 + 5 * i) for i in range(8)])
    blender.key("Return")
    first, second = splines(blender)
    into = np.linalg.inv(np.array(blender.call("matrix", "Sheet")))
    ends = [
        (into @ np.append(spline["points"][i], 1))[:3]
        for spline in (first, second)
        for i in (0, -1)
    ]
    np.testing.assert_allclose(ends[:2], np.array(ends[2:]) * [-1, 1, 1], atol=1e-5)
    assert abs(ends[0][0]) > 0.3  # well beside the plane of the mirror


@pytest.mark.slow
def test_stroke_that_leaves_the_surface_ends_there(blender, sheet, seen):
    start(blender)
    inside = along(seen, ((4.5, 2.0), (3.5, 2.0)), 6)
    blender.stroke([np.array((200, 600)), *inside])
    blender.key("Return")
    (spline,) = splines(blender)
    first, last = (sheet.local(np.array(spline["points"][i])) for i in (0, -1))
    # It begins where the mouse came onto the surface: at most one sample away from the outline.
    assert np.min([first[:2], SIZE - first[:2]]) == pytest.approx(0, abs=0.1)
    np.testing.assert_allclose(last[:2], (3.5, 2.0), atol=0.05)
    drawn = np.array(blender.call("drawn_points", NAME))
    places = np.array([sheet.local(point) for point in drawn])
    known = ((places[:, :2] > 1) & (places[:, :2] < SIZE - 1)).all(axis=1)
    assert known.any()  # on the faces at the boundary the surface is no quadric
    for point in drawn[known]:
        assert abs(sheet.above(point)) < ON_SURFACE


@pytest.mark.slow
def test_nothing_drawn_is_nothing_made(blender, sheet, seen):
    there = blender.call("contents")
    start(blender)
    blender.stroke([(200, 600), (210, 610)])
    blender.key("Return")
    assert not blender.call("running")
    assert blender.call("contents") == there


def test_drawing_stops_playback(blender, sheet, seen):
    blender.call("animate", "Sheet")
    blender.call("play")
    blender.settle()
    start(blender)
    assert not blender.call("is_playing")
    blender.stroke(along(seen, LINE))
    blender.key("Return")
    assert len(splines(blender)) == 1
    assert_on_sheet(blender, Sheet(blender.call("matrix", "Sheet")))


def test_strokes_go_on_in_another_frame(blender, sheet, seen):
    blender.call("animate", "Sheet")
    blender.call("set_frame", 1)
    start(blender)
    pixels = along(seen, LINE)
    blender.stroke(pixels)
    blender.call("set_frame", 60)
    moved = Sheet(blender.call("matrix", "Sheet"))
    assert np.linalg.norm(moved.matrix - sheet.matrix) > 0.5
    blender.stroke(pixels)
    blender.key("Return")
    first, second = splines(blender)
    camera = Camera(**blender.call("camera"))
    ends = [camera.pixel(np.array(second["points"][i])) for i in (0, -1)]
    np.testing.assert_allclose(ends, [pixels[0], pixels[-1]], atol=0.1)
    ends = [moved.local(np.array(first["points"][i]))[:2] for i in (0, -1)]
    np.testing.assert_allclose(ends, [LINE[0], LINE[-1]], atol=0.02)
    assert_on_sheet(blender, moved)


def test_the_sidebar_is_no_surface(blender):
    blender.call("large_sheet", 20)
    blender.call("look_closely")  # the sheet fills the viewport
    blender.call("show_sidebar")
    blender.settle()
    bar = blender.call("sidebar")
    there = blender.call("contents")
    start(blender)
    x, y = bar["left"] + 40, (bar["bottom"] + bar["top"]) / 2
    blender.stroke([(x + 8 * i, y + 5 * i) for i in range(8)])
    blender.key("Return")
    assert not blender.call("running")
    assert blender.call("contents") == there


def test_other_keys_do_nothing(blender, sheet, seen):
    """Ctrl Space would maximise the viewport."""
    areas = blender.call("area_count")
    start(blender, brush=3)
    blender.stroke(along(seen, LINE))
    blender.key("ctrl+space", "shift+space", "ctrl+x", "ctrl+j", "alt+Return")
    assert blender.call("running")
    assert blender.call("area_count") == areas
    blender.key("bracketleft", "bracketright", "Return")
    assert len(splines(blender)) == 1
    assert blender.call("next_settings", "view3d.limit_draw", "brush") == [3]


def test_no_text_stays_where_another_workspace_is_shown_meanwhile(blender, sheet):
    x, y = blender.call("view_centre")
    before = blender.screenshot("draw_before")
    start(blender)
    for name in ("Rendering", "Layout"):
        blender.call("show_workspace", name)
        blender.settle()
        blender.move(x + 20, y)
        blender.key("Return")  # ends it in the first
    assert not blender.call("running")
    blender.move(x, y)
    after = blender.screenshot("draw_status")
    keys = np.s_[-20:, :400]  # where the status bar named them
    np.testing.assert_array_equal(after[keys], before[keys])


def test_begun_by_the_button_and_adjusted_afterwards(blender, sheet, seen):
    blender.call("remember")
    blender.open_tab()
    blender.click(*blender.find_button("view3d.limit_draw"))
    blender.stroke(along(seen, LINE))
    blender.key("Return")
    assert len(splines(blender)) == 1
    blender.move(*seen(3, 3))
    fields = blender.open_redo_panel()
    blender.screenshot("draw_redo")
    blender.move(*blender.find_field(*fields, value="0.01"))
    blender.key("Return", "ctrl+a", "0", "period", "0", "5", "Return")
    blender.settle()
    assert blender.call("bevel_depth", NAME) == pytest.approx(
        0.05 / np.cbrt(np.linalg.det(sheet.matrix[:3, :3])), rel=1e-5
    )
    assert blender.call("objects") == [NAME, "Sheet"]


@pytest.mark.slow
def test_stroke_on_a_hundred_thousand_faces(blender):
    """Its speed is measured by tools/bench_window.py."""
    drags.draw_over_large_sheet(blender, moves=10)
    blender.release()
    blender.key("Return")
    found = splines(blender)
    assert len(found) == 3  # the circle leaves the sheet twice
    for x, y, z in (point for spline in found for point in spline["points"]):
        assert z == pytest.approx(0.2 * np.sin(3 * x) * np.cos(2 * y), abs=1e-3)


@pytest.mark.slow
def test_what_is_shown_while_drawing(blender, sheet, seen):
    blender.call("smooth_sheet")
    before = blender.screenshot("draw_before")
    start(blender)
    blender.stroke(along(seen, LINE))
    blender.move(*seen(2, 3.5))
    drawn = blender.screenshot("draw")
    assert np.count_nonzero(is_near(drawn, STROKE) & ~is_near(before, STROKE)) > 100
    blender.key("Escape", "Escape")
    left = blender.screenshot("draw_ended")
    assert np.count_nonzero(is_near(left, STROKE)) == np.count_nonzero(is_near(before, STROKE))
