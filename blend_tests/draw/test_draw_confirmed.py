# SPDX-License-Identifier: GPL-3.0-or-later
"""view3d.limit_draw from its start to Enter, when something has changed the file meanwhile: another
extension, for example.
"""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bmesh
import bpy
import draw_scenes as drawn
import numpy as np
import pytest
import scenes
import stand_ins
from limit_surface.draw.operator import VIEW3D_OT_limit_draw
from limit_surface.draw.stroke import LIMIT_PG_draw_point, LIMIT_PG_draw_spline

STROKE = drawn.Given([5, 5, 6], [(0.2, 0.5), (0.8, 0.5), (0.5, 0.5)])


class Pen:
    """Draws one stroke, and takes any event for Enter."""

    def __init__(self, _area, session, brush, _use_pressure):
        self.session, self.brush, self.obstacle = session, brush, ""
        session.strokes.append(session.ground.stroke(STROKE.face, STROKE.uv, np.ones(3)))

    def take(self, _context, _event):
        return {"FINISHED"}

    def show(self, _context):
        pass

    def stand_on(self, ground):
        self.obstacle = ""
        self.session.stand_on(ground)

    def close(self, _context):
        self.is_closed = True


@pytest.fixture
def start(monkeypatch):
    """Returns a function that starts a stand-in for the operator, and returns it."""
    monkeypatch.setattr("limit_surface.draw.operator.Pen", Pen)
    points = bpy.props.CollectionProperty(type=LIMIT_PG_draw_point)
    numbers = bpy.props.CollectionProperty(type=LIMIT_PG_draw_spline)
    bpy.types.Scene.drawn_strokes, bpy.types.Scene.drawn_removed = points, numbers

    def started(**chosen):
        own = vars(VIEW3D_OT_limit_draw).items()
        own = {name: value for name, value in own if not name.startswith(("bl_", "__"))}
        bases = [b for b in VIEW3D_OT_limit_draw.__bases__ if b is not bpy.types.Operator]
        operator = type("StandIn", tuple(bases), own)()
        kind = bpy.ops.view3d.limit_draw.get_rna_type()
        for prop in kind.properties:
            if prop.identifier != "rna_type" and prop.type != "COLLECTION":
                setattr(operator, prop.identifier, chosen.get(prop.identifier, prop.default))
        scene = bpy.context.scene
        operator.strokes, operator.removed = scene.drawn_strokes, scene.drawn_removed
        operator.properties = SimpleNamespace(bl_rna=SimpleNamespace(properties=[]))
        operator.report = MagicMock()
        context = stand_ins.window_context()
        context.area = SimpleNamespace(type="VIEW_3D")
        operator.answer = operator.invoke(context, None)
        operator.enter = lambda: operator.modal(stand_ins.window_context(), None)
        return operator

    yield started
    del bpy.types.Scene.drawn_strokes, bpy.types.Scene.drawn_removed


def said(operator):
    return " ".join(call.args[1] for call in operator.report.call_args_list)


@pytest.fixture
def target():
    return scenes.flat_grid(4)


def test_the_stroke_is_on_the_surface_as_it_is_at_the_end(start, target):
    operator = start()
    for vertex in target.data.vertices:
        vertex.co.z += 1
    target.data.update()
    target.location.x = 3
    bpy.context.view_layer.update()
    assert operator.enter() == {"FINISHED"}
    shown = drawn.world_points(bpy.context.active_object, 0)
    assert drawn.distance_from(target, shown).max() < 1e-5
    wanted = drawn.world_places(target, STROKE)
    assert drawn.distance_from_polyline(wanted, shown).max() < 1e-3


def rise(ob):
    """Animates the object upwards, by 5 until frame 6."""
    for frame in (1, 6):
        ob.location.z = frame - 1
        ob.keyframe_insert("location", frame=frame)


def test_drawn_strokes_are_not_mirrored_again(start, target):
    """They have their mirror images already, as those of this stand-in for the pen would."""
    for vertex in target.data.vertices:
        vertex.co.x -= 2  # the mirrored place is on the surface, too
    bpy.context.view_layer.update()
    operator = start(use_mirror=True)
    assert operator.enter() == {"FINISHED"}
    drawing = bpy.context.active_object
    assert len(drawing.data.splines) == 1
    bpy.data.objects.remove(drawing)
    scenes.activate(target)
    assert operator.execute(stand_ins.window_context()) == {"FINISHED"}  # as the redo panel does
    assert len(bpy.context.active_object.data.splines) == 1


def test_drawing_goes_on_where_the_surface_is_in_another_frame(start, target):
    rise(target)
    bpy.context.scene.frame_set(1)
    operator = start()
    session = operator._pen.session
    (before,) = session.strokes
    bpy.context.scene.frame_set(6)
    operator._keep_up(stand_ins.window_context())
    hit = session.ground.surface.ray_cast([[1.0, 1, 20]], [[0.0, 0, -1]])
    assert hit.position[0, 2] == pytest.approx(5)
    (after,) = session.strokes
    np.testing.assert_array_equal(after.face, before.face)
    np.testing.assert_array_equal(after.uv, before.uv)
    np.testing.assert_allclose(after.position, before.position + (0, 0, 5), atol=1e-6)
    ground = session.ground
    operator._keep_up(stand_ins.window_context())
    assert session.ground is ground
    assert operator.enter() == {"FINISHED"}
    shown = drawn.world_points(bpy.context.active_object, 0)
    np.testing.assert_allclose(shown[:, 2], 5, atol=1e-5)
    assert not any("SurfaceWatch" in str(each) for each in bpy.app.handlers.frame_change_post)


def test_the_surface_is_read_again_only_after_it_has_changed(start, target, monkeypatch):
    other = bpy.data.objects.new("Other", None)
    bpy.context.collection.objects.link(other)
    rise(other)
    bpy.context.scene.frame_set(1)
    operator = start()
    monkeypatch.setattr(operator._pen.session.ground, "now", None)
    bpy.context.scene.frame_set(6)
    operator._keep_up(stand_ins.window_context())  # would fail if it asked


def test_nothing_is_drawn_while_the_surface_has_other_faces(start, target):
    operator = start()
    faces = target.modifiers.new("Triangles", "TRIANGULATE")
    bpy.context.view_layer.update()
    operator._keep_up(stand_ins.window_context())
    assert operator._pen.obstacle.startswith("The faces of Flat have changed meanwhile")
    assert operator.enter() == {"RUNNING_MODAL"}
    assert "The faces of Flat have changed meanwhile" in said(operator)
    assert not bpy.data.curves
    target.modifiers.remove(faces)
    bpy.context.view_layer.update()
    operator._keep_up(stand_ins.window_context())
    assert not operator._pen.obstacle
    assert operator.enter() == {"FINISHED"}


def test_a_surface_with_other_faces_is_refused(start, target):
    operator = start()
    edited = bmesh.new()
    edited.from_mesh(target.data)
    edited.faces.ensure_lookup_table()
    bmesh.ops.delete(edited, geom=[edited.faces[0]], context="FACES_ONLY")
    edited.to_mesh(target.data)
    edited.free()
    assert operator.enter() == {"CANCELLED"}
    assert "The faces of Flat have changed meanwhile" in said(operator)
    assert operator._pen.is_closed
    assert not bpy.data.curves


def test_a_surface_that_is_gone_is_refused(start, target):
    operator = start()
    bpy.data.objects.remove(target)
    assert operator.enter() == {"CANCELLED"}
    assert "Flat does not exist any more" in said(operator)
    assert operator._pen.is_closed


def test_what_cannot_follow_is_refused_before_anything_is_drawn(start, target):
    shown, rendered = scenes.add_subsurf(target), scenes.add_subsurf(target)
    shown.show_render = rendered.show_viewport = False
    operator = start(follow="NODES")
    assert operator.answer == {"CANCELLED"}
    assert "subdivided first by" in said(operator)
