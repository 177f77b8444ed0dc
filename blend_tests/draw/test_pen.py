# SPDX-License-Identifier: GPL-3.0-or-later
"""The events of view3d.limit_draw, with a viewport that looks straight down and has no window."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.draw.ground import Ground
from limit_surface.draw.pen import Pen
from limit_surface.draw.session import Session, Settings
from mathutils import Matrix

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
def context():
    status = SimpleNamespace(text="", status_text_set=lambda text: None)
    return SimpleNamespace(workspace=status)


@pytest.fixture
def pen(area):
    ob = scenes.flat_grid(4)
    bpy.context.view_layer.update()
    ground = Ground(ob, bpy.context.evaluated_depsgraph_get())
    return Pen(area, Session(ground, Settings(TOLERANCE), []), 20, True)


def event(kind, value="PRESS", at=(0, 0), ctrl=False, shift=False, pressure=None):
    return SimpleNamespace(
        type=kind,
        value=value,
        mouse_x=at[0],
        mouse_y=at[1],
        ctrl=ctrl,
        shift=shift,
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


def test_view_can_be_moved_between_strokes(pen, context):
    assert pen.take(context, event("MIDDLEMOUSE")) == {"PASS_THROUGH"}
    assert pen.take(context, event("WHEELUPMOUSE")) == {"PASS_THROUGH"}


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


def test_stroke_is_divided_where_it_leaves_the_surface(pen, context):
    stroke(pen, context, [(0.6, 2), (-0.5, 2), (-0.5, 2.5), (0.6, 2.5)])
    assert len(pen.session.strokes) == 2


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
