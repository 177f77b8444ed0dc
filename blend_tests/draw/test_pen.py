# SPDX-License-Identifier: GPL-3.0-or-later
"""The events of view3d.limit_draw, with a viewport that looks straight down and has no window."""

from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.draw.ground import Ground
from limit_surface.draw.pen import Pen
from limit_surface.draw.session import Session, Settings
from mathutils import Matrix
from stand_ins import status_text, window_context

SIDE = 400  # pixels that show 4 units
TOLERANCE = 1e-3


class Area(SimpleNamespace):
    def tag_redraw(self):
        pass

    def header_text_set(self, text):
        self.header = text


@pytest.fixture
def area():
    """Shows x and y from 0 to 4."""
    shown = Matrix.Diagonal((0.5, 0.5, -0.01, 1)) @ Matrix.Translation((-2, -2, 0))
    view = SimpleNamespace(
        perspective_matrix=shown,
        view_matrix=Matrix.Translation((-2, -2, -10)),
        is_perspective=False,
        view_perspective="ORTHO",
    )
    region = SimpleNamespace(type="WINDOW", x=0, y=0, width=SIDE, height=SIDE, data=view)
    return Area(regions=[region], header="")


@pytest.fixture
def context(area):
    made = window_context()
    made.screen = SimpleNamespace(areas=[area])
    return made


@pytest.fixture
def pen(area, context):
    ob = scenes.flat_grid(4)
    bpy.context.view_layer.update()
    ground = Ground(ob, bpy.context.evaluated_depsgraph_get())
    made = Pen(area, Session(ground, Settings(TOLERANCE), []), 20, True)
    yield made
    made.close(context)


def event(kind, value="PRESS", at=(0, 0), pressure=None, is_repeat=False, **held):
    modifiers = {name: name in held for name in ("ctrl", "shift", "alt", "oskey")}
    return SimpleNamespace(
        type=kind,
        value=value,
        mouse_x=at[0],
        mouse_y=at[1],
        **modifiers,
        is_repeat=is_repeat,
        is_tablet=pressure is not None,
        pressure=1.0 if pressure is None else pressure,
    )


def stroke(pen, context, places, **held):
    """Drags over places, in units of the sheet."""
    pixels = [(int(100 * x), int(100 * y)) for x, y in places]
    pen.take(context, event("MOUSEMOVE", "NOTHING", pixels[0], **held))
    assert pen.take(context, event("LEFTMOUSE", "PRESS", pixels[0], **held)) == {"RUNNING_MODAL"}
    for at in pixels[1:]:
        pen.take(context, event("MOUSEMOVE", "NOTHING", at, **held))
    pen.take(context, event("LEFTMOUSE", "RELEASE", pixels[-1], **held))


def ends(drawn):
    return drawn.position[[0, -1], :2]


def test_stroke(pen, context, area):
    stroke(pen, context, [(1, 1), (2, 1.5), (3, 1)])
    (drawn,) = pen.session.strokes
    np.testing.assert_allclose(ends(drawn), [(1, 1), (3, 1)], atol=1e-5)
    np.testing.assert_allclose(drawn.position[:, 2], 0, atol=1e-9)
    assert "Strokes: 1" in area.header
    assert pen.take(context, event("RET")) == {"FINISHED"}


def test_escape_drops_the_stroke_and_then_ends(pen, context):
    pen.take(context, event("LEFTMOUSE", "PRESS", (100, 100)))
    pen.take(context, event("MOUSEMOVE", "NOTHING", (200, 100)))
    assert pen.take(context, event("ESC")) == {"RUNNING_MODAL"}
    assert not pen.session.strokes
    assert pen.take(context, event("ESC")) == {"CANCELLED"}
    pen.close(context)
    pen.close(context)  # Blender may ask for it again


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_strokes_are_discarded_only_after_a_question(pen, context, area, key):
    stroke(pen, context, [(1, 1), (2, 1)])
    stroke(pen, context, [(1, 2), (2, 2)])
    assert pen.take(context, event(key)) == {"RUNNING_MODAL"}
    assert area.header.startswith("Discard 2 strokes?")
    assert "discard what was drawn" in status_text(context)
    pen.take(context, event("MOUSEMOVE", "NOTHING", (100, 100)))
    assert pen.take(context, event("MIDDLEMOUSE")) == {"PASS_THROUGH"}
    assert area.header.startswith("Discard 2 strokes?")
    assert len(pen.session.strokes) == 2
    assert pen.take(context, event(key, "RELEASE")) == {"RUNNING_MODAL"}
    assert pen.take(context, event(key)) == {"CANCELLED"}


def test_a_key_that_is_held_does_not_answer_its_own_question(pen, context):
    stroke(pen, context, [(1, 1), (2, 1)])
    pen.take(context, event("ESC"))
    for _ in range(3):
        assert pen.take(context, event("ESC", is_repeat=True)) == {"RUNNING_MODAL"}
    assert pen.take(context, event("RET")) == {"FINISHED"}


def test_drawing_goes_on_after_the_question(pen, context, area):
    stroke(pen, context, [(1, 1), (2, 1)])
    pen.take(context, event("ESC"))
    stroke(pen, context, [(1, 2), (2, 2)])
    assert "Strokes: 2" in area.header
    assert pen.take(context, event("ESC")) == {"RUNNING_MODAL"}
    pen.take(context, event("Z", ctrl=True))
    pen.take(context, event("Z", ctrl=True))
    assert pen.take(context, event("ESC")) == {"CANCELLED"}  # nothing is lost


def test_view_can_be_moved_between_strokes(pen, context):
    assert pen.take(context, event("MIDDLEMOUSE")) == {"PASS_THROUGH"}
    assert pen.take(context, event("WHEELUPMOUSE")) == {"PASS_THROUGH"}
    assert pen.take(context, event("NUMPAD_1", ctrl=True)) == {"PASS_THROUGH"}


def test_nothing_else_than_the_view_is_left_to_blender(pen, context):
    """With these modifiers the wheel and the keys change the frame, fields, the selection or the
    camera.
    """
    for kind, held in (
        ("WHEELUPMOUSE", "alt"),
        ("NUMPAD_0", "ctrl"),
        ("NUMPAD_PLUS", "ctrl"),
        ("NUMPAD_0", "alt"),
    ):
        assert pen.take(context, event(kind, **{held: True})) == {"RUNNING_MODAL"}
    beside = (SIDE + 10, 10)
    assert pen.take(context, event("WHEELUPMOUSE", at=beside)) == {"PASS_THROUGH"}
    assert pen.take(context, event("WHEELUPMOUSE", at=beside, ctrl=True)) == {"RUNNING_MODAL"}


def test_pressure(pen, context):
    stroke(pen, context, [(1, 1), (2, 1)], pressure=0.5)
    (drawn,) = pen.session.strokes
    np.testing.assert_allclose(drawn.radius, 0.5)


def test_undo_and_redo(pen, context):
    stroke(pen, context, [(1, 1), (2, 1)])
    stroke(pen, context, [(1, 2), (2, 2)])
    pen.take(context, event("Z", ctrl=True))
    assert len(pen.session.strokes) == 1
    pen.take(context, event("Z", ctrl=True, shift=True))
    assert len(pen.session.strokes) == 2


def test_erasing_divides(pen, context):
    stroke(pen, context, [(1, 1), (3, 1)])
    stroke(pen, context, [(2, 1), (2.02, 1)], ctrl=True)
    first, second = pen.session.strokes
    gap = np.concatenate([first.position, second.position])
    assert np.linalg.norm(gap[:, :2] - (2, 1), axis=1).min() >= 0.19
    pen.take(context, event("Z", ctrl=True))
    assert len(pen.session.strokes) == 1


def test_smoothing_straightens(pen, context):
    pen.session.settings.steadying = 0
    zigzag = [(1 + 0.1 * i, 2 + 0.05 * (i % 2)) for i in range(21)]
    stroke(pen, context, zigzag)
    before = np.ptp(pen.session.strokes[0].position[5:-5, 1])
    for _ in range(5):
        stroke(pen, context, [(1, 2.02), (3, 2.02)], shift=True)
    (drawn,) = pen.session.strokes
    assert np.ptp(drawn.position[5:-5, 1]) < 0.5 * before


def test_continued_and_closed(pen, context):
    stroke(pen, context, [(1, 1), (3, 1), (3, 3)])
    stroke(pen, context, [(3, 3), (1, 3), (1, 1.02)])
    (drawn,) = pen.session.strokes
    assert drawn.is_closed


def test_keys_switch_joining_and_mirroring(pen, context):
    pen.take(context, event("J"))
    stroke(pen, context, [(1, 1), (2, 1)])
    stroke(pen, context, [(2, 1), (2, 2)])
    assert len(pen.session.strokes) == 2
    pen.take(context, event("X"))
    assert pen.session.settings.is_mirrored
    pen.take(context, event("RIGHT_BRACKET"))
    assert pen.brush == 25


def test_keys_with_other_modifiers_do_nothing(pen, context):
    stroke(pen, context, [(1, 1), (2, 1)])
    for kind in ("SPACE", "RET", "ESC", "RIGHTMOUSE", "X", "J", "LEFT_BRACKET", "Z"):
        for held in ("ctrl", "shift", "alt", "oskey"):
            if (kind, held) != ("Z", "ctrl"):
                assert pen.take(context, event(kind, **{held: True})) == {"RUNNING_MODAL"}
    assert not pen.session.settings.is_mirrored
    assert pen.session.settings.continues
    assert pen.brush == 20
    assert len(pen.session.strokes) == 1


def test_drags_with_other_modifiers_do_nothing(pen, context):
    stroke(pen, context, [(1, 1), (3, 1)])
    (before,) = pen.session.strokes
    for held in ({"alt": True}, {"ctrl": True, "shift": True}, {"oskey": True}):
        stroke(pen, context, [(1.5, 1), (2.5, 1)], **held)
    (after,) = pen.session.strokes
    assert after is before


def brushes(pen, context, kind, count):
    """Returns the brush after each press of a key."""
    found = []
    for _ in range(count):
        pen.take(context, event(kind))
        found.append(pen.brush)
    return found


def test_each_key_of_the_brush_takes_back_the_other(pen, context):
    pen.brush = 25
    down = brushes(pen, context, "LEFT_BRACKET", 12)
    assert down == [20, 16, 13, 10, 8, 7, 5, 4, 3, 2, 1, 1]
    assert brushes(pen, context, "RIGHT_BRACKET", 11) == [*down[-3::-1], 25]
    up = brushes(pen, context, "RIGHT_BRACKET", 18)
    assert up[-2:] == [1000, 1000]
    assert brushes(pen, context, "LEFT_BRACKET", 17) == [*up[-3::-1], 25]


@pytest.mark.parametrize("begun", range(1, 60))
def test_each_step_of_the_brush_changes_it(pen, context, begun):
    pen.brush = begun
    (larger,) = brushes(pen, context, "RIGHT_BRACKET", 1)
    assert begun < larger <= max(begun + 1, 1.5 * begun)
    pen.brush = begun
    (smaller,) = brushes(pen, context, "LEFT_BRACKET", 1)
    assert begun / 2 <= smaller < begun or smaller == begun == 1


def overlap(area, kind, **place):
    """Adds a region that lies over the viewport."""
    area.regions.append(SimpleNamespace(type=kind, **place))


@pytest.mark.parametrize("kind", ["UI", "TOOLS", "HEADER", "TOOL_HEADER", "HUD", "ASSET_SHELF"])
def test_what_lies_over_the_viewport_is_no_surface(pen, context, area, kind):
    overlap(area, kind, x=200, y=0, width=100, height=SIDE)
    stroke(pen, context, [(2.2, 1), (2.8, 1)])
    assert not pen.session.strokes
    assert "no surface under the mouse" in area.header
    stroke(pen, context, [(1, 2), (3.5, 2)])
    first, second = pen.session.strokes
    np.testing.assert_allclose(ends(first), [(1, 2), (2, 2)], atol=0.05)
    np.testing.assert_allclose(ends(second), [(3, 2), (3.5, 2)], atol=0.05)


def test_regions_that_are_hidden_cover_nothing(pen, context, area):
    overlap(area, "UI", x=100, y=100, width=1, height=1)
    stroke(pen, context, [(1, 1), (2, 1)])
    assert len(pen.session.strokes) == 1


def test_another_workspace_is_shown_meanwhile(pen, context, area):
    """Nothing is drawn through a viewport that is not seen, and no text stays anywhere."""
    stroke(pen, context, [(1, 1), (2, 1)])
    context.screen = SimpleNamespace(areas=[])
    stroke(pen, context, [(1, 2), (2, 2)])
    assert len(pen.session.strokes) == 1
    pen.close(context)
    context.workspace.status_text_set.assert_called_with(None)
    assert area.header is None


def test_stroke_is_divided_where_it_leaves_the_surface(pen, context):
    stroke(pen, context, [(0.6, 2), (-0.5, 2), (-0.5, 2.5), (0.6, 2.5)])
    assert len(pen.session.strokes) == 2


def moved(pen, **place):
    """Moves the surface, and returns it as it is then."""
    ob = pen.session.ground.ob
    for name, value in place.items():
        setattr(ob.location, name, value)
    bpy.context.view_layer.update()
    return pen.session.ground.now(ob, bpy.context.evaluated_depsgraph_get())


def test_strokes_stay_at_their_locations_while_the_surface_moves(pen, context):
    stroke(pen, context, [(1, 1), (2, 1)])
    stroke(pen, context, [(1, 2), (2, 2)])
    pen.take(context, event("Z", ctrl=True))
    pen.take(context, event("LEFTMOUSE", "PRESS", (100, 300)))
    pen.take(context, event("MOUSEMOVE", "NOTHING", (200, 300)))
    pen.stand_on(moved(pen, x=1))
    np.testing.assert_allclose(pen._overlay.pen[0][[0, -1], :2], [(2, 3), (3, 3)], atol=1e-5)
    pen.take(context, event("MOUSEMOVE", "NOTHING", (350, 300)))
    pen.take(context, event("LEFTMOUSE", "RELEASE", (350, 300)))
    first, second = pen.session.strokes
    np.testing.assert_allclose(ends(first), [(2, 1), (3, 1)], atol=1e-5)
    np.testing.assert_allclose(ends(second), [(2, 3), (3.5, 3)], atol=1e-5)
    pen.take(context, event("Z", ctrl=True))
    (kept,) = pen.session.strokes
    assert kept is first
    pen.stand_on(moved(pen, x=0))
    pen.take(context, event("Z", ctrl=True, shift=True))
    np.testing.assert_allclose(ends(pen.session.strokes[1]), [(1, 3), (2.5, 3)], atol=1e-5)


def test_strokes_that_splines_hold_are_not_changed_by_a_surface_that_moves(pen):
    ground = pen.session.ground
    held = [ground.stroke([0, 1], [(0.5, 0.5)] * 2, np.ones(2))]
    held = [replace(each, spline=3) for each in held]
    pen.session = Session(ground, Settings(TOLERANCE), held)
    pen.stand_on(moved(pen, x=1))
    assert not pen.session.is_changed


def test_nothing_is_drawn_at_an_obstacle(pen, context, area):
    pen.obstacle = "The faces have changed"
    stroke(pen, context, [(1, 1), (2, 1)])
    assert not pen.session.strokes
    assert "The faces have changed" in area.header
    pen.stand_on(pen.session.ground)
    stroke(pen, context, [(1, 1), (2, 1)])
    assert len(pen.session.strokes) == 1


def test_a_notice_is_shown_until_something_is_drawn(pen, context, area):
    pen.notice = "Playback was stopped"
    pen.take(context, event("MOUSEMOVE", "NOTHING", (100, 100)))
    assert "Playback was stopped" in area.header
    stroke(pen, context, [(1, 1), (2, 1)])
    assert "Playback" not in area.header


def test_mirror(pen, context):
    ob = pen.session.ground.ob
    ob.data.transform(Matrix.Translation((-2, 0, 0)))
    ob.location.x = 2
    bpy.context.view_layer.update()
    ground = Ground(ob, bpy.context.evaluated_depsgraph_get())
    pen.session = Session(ground, Settings(TOLERANCE, is_mirrored=True), [])
    stroke(pen, context, [(2.5, 1), (3, 2)])
    one, other = pen.session.strokes
    np.testing.assert_allclose(ends(one), [(2.5, 1), (3, 2)], atol=1e-5)
    np.testing.assert_allclose(ends(other), [(1.5, 1), (1, 2)], atol=1e-5)


def mirrored(pen):
    """Mirrors along the plane x = 0, where the sheet begins."""
    pen.session = Session(pen.session.ground, Settings(TOLERANCE, is_mirrored=True), [])
    pen.session.settings.steadying = 0


def test_no_mirror_image_where_the_surface_has_no_other_half(pen, context, area):
    mirrored(pen)
    stroke(pen, context, [(0.5, 1), (3, 2)])
    (drawn,) = pen.session.strokes
    np.testing.assert_allclose(ends(drawn), [(0.5, 1), (3, 2)], atol=1e-5)
    assert "no surface at the mirrored place" in area.header
    pen.take(context, event("X"))
    assert "mirrored place" not in area.header


def test_mirrored_brushes_touch_nothing_where_the_surface_has_no_other_half(pen, context):
    mirrored(pen)
    stroke(pen, context, [(0.05, 1), (0.05, 3)])
    (before,) = pen.session.strokes
    stroke(pen, context, [(0.29, 2), (0.3, 2)], ctrl=True)  # its radius is 0.2
    (after,) = pen.session.strokes
    assert after is before


def lopsided(pen, asymmetry):
    """Returns the session on a sheet from x = -2 to 1.5, whose left half bulges by a share of the
    extent, mirrored at x = 2 in the view.
    """
    ob = pen.session.ground.ob
    ob.data.transform(Matrix.Translation((-2, 0, 0)))
    ob.location.x = 2
    bulge = asymmetry * pen.session.ground.size
    for vertex in ob.data.vertices:
        if vertex.co.x < -0.5:
            vertex.co.z += bulge
        vertex.co.x = min(vertex.co.x, 1.5)
    ob.data.update()
    bpy.context.view_layer.update()
    ground = Ground(ob, bpy.context.evaluated_depsgraph_get())
    pen.session = Session(ground, Settings(TOLERANCE, is_mirrored=True), [])


def test_mirror_images_on_a_sculpt_that_is_not_quite_symmetric(pen, context, area):
    lopsided(pen, 0.02)
    stroke(pen, context, [(3.2, 1), (3, 3)])
    one, other = pen.session.strokes
    assert "mirrored place" not in area.header
    np.testing.assert_allclose(ends(other)[:, 1], ends(one)[:, 1], atol=0.05)
    assert other.position[:, 2].min() > 0.05


def test_a_mirror_image_ends_where_the_surface_does(pen, context, area):
    lopsided(pen, 0)
    stroke(pen, context, [(1.5, 2), (0.1, 2)])
    one, other = pen.session.strokes
    np.testing.assert_allclose(ends(one), [(1.5, 2), (0.1, 2)], atol=1e-5)
    np.testing.assert_allclose(ends(other), [(2.5, 2), (3.5, 2)], atol=0.06)
    assert "no surface at the mirrored place" in area.header
