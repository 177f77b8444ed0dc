# SPDX-License-Identifier: GPL-3.0-or-later
"""view3d.limit_snap_modal with real mouse, wheel and keys."""

import numpy as np
import pytest
from quadric import Camera, boundary_height, height

ON_SURFACE = 1e-6  # the error of Blender's single precision for coordinates up to 4
PIXEL = 0.1  # the error of single precision in the view's inverted matrix

DRAWN = ((0.25, 0.55, 1.0), (1.0, 0.45, 0.1), (0.2, 0.85, 0.35))  # normal, principal directions
STORED = ("limit_face", "limit_uv", "rest_root")


def position(blender, name):
    return np.array(blender.call("matrix", name))[:3, 3]


def pixel(blender, point):
    return Camera(**blender.call("camera")).pixel(point)


def assert_under_mouse(blender, point, at):
    np.testing.assert_allclose(pixel(blender, point), at, atol=PIXEL)


def test_object_follows_the_mouse_until_a_click(blender, sheet, seen):
    blender.call("pin")
    before = blender.call("transform", "Pin")
    blender.call("start_drag")
    for place in ((2.3, 1.4), (3.7, 2.9), (4.4, 3.1)):
        at = seen(*place)
        blender.move(*at)
        found = position(blender, "Pin")
        assert abs(sheet.above(found)) < ON_SURFACE
        assert_under_mouse(blender, found, at)
    assert blender.call("running")
    blender.press()
    assert not blender.call("running")
    np.testing.assert_array_equal(position(blender, "Pin"), found)
    after = blender.call("transform", "Pin")
    assert after[1:] == before[1:]
    assert blender.call("objects") == ["Pin", "Sheet"]
    blender.key("ctrl+z")
    assert blender.call("transform", "Pin") == before
    blender.key("ctrl+shift+z")
    assert blender.call("transform", "Pin") == after


@pytest.mark.parametrize("way_out", ["Escape", pytest.param("right click", marks=pytest.mark.slow)])
def test_all_is_restored(blender, sheet, seen, way_out):
    blender.call("pin")
    before = blender.call("transform", "Pin")
    blender.call("start_drag", align="NORMAL_DU")
    blender.move(*seen(3.2, 2.2))
    blender.wheel(3)
    assert blender.call("transform", "Pin") != before
    if way_out == "Escape":
        blender.key("Escape")
    else:
        blender.press(3)
    assert not blender.call("running")
    assert blender.call("transform", "Pin") == before


def test_wheel_and_numbers_offset_along_the_normal(blender, sheet, seen):
    blender.call("pin")
    blender.call("start_drag")
    blender.move(*seen(3.2, 2.2))
    foot = position(blender, "Pin")
    normal = sheet.world_normal(sheet.local(foot))
    blender.wheel(3)
    step = np.linalg.norm(position(blender, "Pin") - foot) / 3
    # the sheet's diagonal is slightly more than 10
    assert step == pytest.approx(0.1, abs=ON_SURFACE)
    np.testing.assert_allclose(position(blender, "Pin"), foot + 3 * step * normal, atol=ON_SURFACE)
    blender.wheel(-1)
    np.testing.assert_allclose(position(blender, "Pin"), foot + 2 * step * normal, atol=ON_SURFACE)
    blender.key("0", "period", "2", "5")
    np.testing.assert_allclose(position(blender, "Pin"), foot + 0.25 * normal, atol=ON_SURFACE)
    blender.key("minus", "BackSpace")
    np.testing.assert_allclose(position(blender, "Pin"), foot - 0.2 * normal, atol=ON_SURFACE)
    blender.key("Return")
    assert not blender.call("running")
    np.testing.assert_allclose(position(blender, "Pin"), foot - 0.2 * normal, atol=ON_SURFACE)


@pytest.mark.slow
def test_align(blender, sheet, seen):
    blender.call("pin")
    blender.call("start_drag")
    blender.move(*seen(3.2, 2.2))
    normal = sheet.world_normal(sheet.local(position(blender, "Pin")))
    before = np.array(blender.call("matrix", "Pin"))
    blender.key("a")
    after = np.array(blender.call("matrix", "Pin"))
    np.testing.assert_allclose(after[:3, 2] / np.linalg.norm(after[:3, 2]), normal, atol=1e-6)
    np.testing.assert_allclose(
        np.linalg.norm(after[:3, :3], axis=0), np.linalg.norm(before[:3, :3], axis=0), rtol=1e-6
    )
    blender.key("a", "a")
    np.testing.assert_array_equal(np.array(blender.call("matrix", "Pin")), before)
    blender.key("Escape")


@pytest.mark.slow
def test_along_a_face_border(blender, sheet, seen):
    blender.call("pin")
    blender.call("start_drag")
    blender.move(*seen(3.2, 2.45))
    blender.key("x")
    x, y, z = sheet.local(position(blender, "Pin"))
    assert abs(x - 3) < ON_SURFACE
    assert abs(z - height(x, y)) < ON_SURFACE
    blender.move(*seen(3.6, 2.1))
    x, y, z = sheet.local(position(blender, "Pin"))
    assert abs(y - 2) < ON_SURFACE
    assert abs(z - height(x, y)) < ON_SURFACE
    blender.key("x")
    assert_under_mouse(blender, position(blender, "Pin"), seen(3.6, 2.1))
    blender.key("Escape")


@pytest.mark.slow
def test_along_the_boundary(blender, sheet, seen):
    """This also works where the mouse is beside the surface: it gives the nearest point of the
    curve on screen.
    """
    blender.call("pin")
    blender.call("start_drag")
    blender.move(*seen(2.8, 1.2))
    blender.key("y")
    camera = Camera(**blender.call("camera"))
    curve_x = np.linspace(1, 5, 4001)
    curve = [sheet.world(np.array([x, 0, boundary_height(x)])) for x in curve_x]
    on_screen = np.array([camera.pixel(point) for point in curve])
    for at in (seen(2.8, 0.3), np.round(on_screen[2000] + [0, -40])):
        blender.move(*at)
        found = sheet.local(position(blender, "Pin"))
        assert abs(found[1]) < ON_SURFACE
        assert abs(found[2] - boundary_height(found[0])) < ON_SURFACE
        nearest = np.argmin(np.linalg.norm(on_screen - at, axis=1))
        assert abs(found[0] - curve_x[nearest]) < 0.01
    blender.key("z")
    blender.move(*seen(2.8, 1.2))
    assert_under_mouse(blender, position(blender, "Pin"), seen(2.8, 1.2))
    blender.key("Escape")


def test_vertex_is_pressed_and_dragged(blender, sheet, seen):
    blender.call("loose_vertices")
    before = blender.call("vertices", "Triangle")
    blender.call("start_drag")
    matrix = np.array(blender.call("matrix", "Triangle"))
    start = matrix[:3, :3] @ before[1] + matrix[:3, 3]
    at = seen(4.1, 2.4)
    blender.drag(pixel(blender, start) + [4, 3], at)
    assert not blender.call("running")
    after = blender.call("vertices", "Triangle")
    assert [after[0], after[2]] == [before[0], before[2]]
    found = matrix[:3, :3] @ after[1] + matrix[:3, 3]
    assert abs(sheet.above(found)) < ON_SURFACE
    assert_under_mouse(blender, found, at)
    blender.key("ctrl+z")
    assert blender.call("vertices", "Triangle") == before


def test_strand_is_clicked_and_dragged_by_its_root(blender, sheet, seen):
    blender.call("hair", 2)
    curve = 57
    before = np.array(blender.call("strand", "Hair", curve))
    others = blender.call("strand", "Hair", curve + 1)
    blender.call("start_drag")
    blender.click(*np.round(pixel(blender, sheet.world(before[0]))))
    assert blender.call("running")
    at = seen(4.1, 2.4)
    blender.move(*at)
    blender.press()
    assert not blender.call("running")
    after = np.array(blender.call("strand", "Hair", curve))
    root = sheet.world(after[0])
    assert abs(sheet.above(root)) < ON_SURFACE
    assert_under_mouse(blender, root, at)
    np.testing.assert_allclose(after - after[0], before - before[0], atol=ON_SURFACE)
    assert blender.call("strand", "Hair", curve + 1) == others
    columns = 6
    face, uv = (
        blender.call("attribute", "Hair", name, curve) for name in ("limit_face", "limit_uv")
    )
    np.testing.assert_allclose(
        [face % columns + uv[0], face // columns + uv[1]], after[0, :2], atol=ON_SURFACE
    )


@pytest.mark.slow
def test_mouse_beside_the_surface_leaves_it_where_it_was(blender, sheet, seen):
    blender.call("pin")
    blender.call("start_drag")
    blender.move(*seen(3.2, 2.2))
    found = position(blender, "Pin")
    blender.move(200, 600)
    np.testing.assert_array_equal(position(blender, "Pin"), found)
    blender.key("Escape")


@pytest.mark.slow
def test_vertex_goes_back(blender, sheet, seen):
    blender.call("loose_vertices")
    before = blender.call("vertices", "Triangle")
    blender.call("start_drag")
    matrix = np.array(blender.call("matrix", "Triangle"))
    blender.click(*pixel(blender, matrix[:3, :3] @ before[1] + matrix[:3, 3]))
    blender.move(*seen(4.1, 2.4))
    assert blender.call("vertices", "Triangle") != before
    blender.key("Escape")
    assert not blender.call("running")
    assert blender.call("vertices", "Triangle") == before


@pytest.mark.slow
def test_strand_goes_back(blender, sheet, seen):
    blender.call("hair", 2)
    before = blender.call("strand", "Hair", 57)
    location = [blender.call("attribute", "Hair", name, 57) for name in STORED]
    blender.call("start_drag", align="NORMAL_DU")
    blender.click(*pixel(blender, sheet.world(np.array(before[0]))))
    blender.move(*seen(4.1, 2.4))
    assert blender.call("strand", "Hair", 57) != before
    blender.press(3)
    assert not blender.call("running")
    assert blender.call("strand", "Hair", 57) == before
    assert [blender.call("attribute", "Hair", name, 57) for name in STORED] == location


def test_begun_by_the_button_and_adjusted_afterwards(blender, sheet, seen):
    blender.call("pin")
    blender.call("remember")
    blender.open_tab()
    blender.click(*blender.find_button("view3d.limit_snap_modal"))
    blender.move(*seen(2.3, 1.4))
    foot = position(blender, "Pin")
    assert abs(sheet.above(foot)) < ON_SURFACE
    blender.press()
    fields = blender.open_redo_panel()
    blender.move(*blender.find_field(*fields, value="0"))
    blender.key("Return", "ctrl+a", "0", "period", "5", "Return")
    blender.settle()
    normal = sheet.world_normal(sheet.local(foot))
    np.testing.assert_allclose(position(blender, "Pin"), foot + 0.5 * normal, atol=ON_SURFACE)


@pytest.mark.slow
def test_what_is_locked_stays(blender, sheet, seen):
    blender.call("pin")
    blender.call("lock_location", "Pin")
    before = blender.call("transform", "Pin")
    blender.call("start_drag")
    blender.move(*seen(2.3, 1.4))
    blender.press()
    assert not blender.call("running")
    assert blender.call("transform", "Pin") == before


@pytest.mark.slow
def test_what_is_drawn(blender, sheet, seen):
    """This test also makes the picture of docs/snap_modal.md."""
    blender.call("smooth_sheet")
    blender.call("pin")
    blender.call("start_drag", align="NORMAL")
    blender.move(*seen(3.4, 2.4))
    blender.wheel(1)
    blender.call("smooth_lines", True)
    drawn = blender.screenshot("snap_modal")
    blender.call("smooth_lines", False)
    assert all(count(drawn, colour) > 50 for colour in DRAWN)
    blender.key("Escape")
    assert not blender.call("running")
    left = blender.screenshot("snap_modal_ended")
    assert all(count(left, colour) == 0 for colour in DRAWN)


def count(pixels, colour):
    return np.count_nonzero((np.abs(pixels - 255 * np.array(colour)) < 10).all(axis=2))
