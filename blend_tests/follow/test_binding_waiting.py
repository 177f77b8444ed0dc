# SPDX-License-Identifier: GPL-3.0-or-later
"""Binding, unbinding, snapping and laying curves while somebody waits: ESC leaves everything as it
was, at once, and what is not cancelled ends as without waiting.

Blender calls these methods of the operators where there is a window; here a stand-in of plain
Python that has them is called instead.
"""

import threading
import time

import bpy
import contents
import numpy as np
import pytest
import scenes
from limit_surface.attach.operator import OBJECT_OT_limit_attach
from limit_surface.draw import fitting
from limit_surface.draw.lay_operator import OBJECT_OT_limit_curve_lay
from limit_surface.errors import CancelledError, RefusalError
from limit_surface.follow.operator import OBJECT_OT_limit_follow
from limit_surface.follow.rebind_operator import OBJECT_OT_limit_rebind
from limit_surface.follow.unbind_operator import OBJECT_OT_limit_unbind
from limit_surface.reading import attributes
from limit_surface.snap.operator import OBJECT_OT_limit_snap
from limit_surface.tasks import piecewise_job, watched_operator
from limit_surface.tasks.job import Job
from limit_surface.tasks.piecewise_job import PiecewiseJob, aside, at_once
from meanwhile_cases import add_cable, select
from stand_ins import event, stand_in_of, status_text, window_context
from waiting import wait_for


def surface():
    ob = scenes.grid_with_holes()
    positions = attributes.read(ob.data, "position")[attributes.read(ob.data, ".corner_vert")]
    uv = (positions[:, :2] / 8).astype(np.float32)
    ob.data.uv_layers.new(name="Flat").data.foreach_set("uv", uv.ravel())
    scenes.add_subsurf(ob)
    return ob


def loose_hair(ob):
    """Adds hair that has no place on the surface yet."""
    hair = scenes.add_hair(ob, per_side=2)
    for name in list(hair.data.attributes.keys()):
        if name.startswith("limit_"):
            hair.data.attributes.remove(hair.data.attributes[name])
    return hair


def bound(mode):
    ob = surface()
    hair = scenes.add_hair(ob, per_side=2)
    scenes.activate(hair)
    assert bpy.ops.object.limit_follow(mode=mode) == {"FINISHED"}
    return ob, hair


def to_follow(mode):
    def case():
        ob = surface()
        select(ob, [loose_hair(ob)])
        return stand_in_of(OBJECT_OT_limit_follow, mode=mode)

    return case


def to_rebind(mode, method):
    def case():
        ob, _hair = bound(mode)
        ob.data.vertices[0].co.z += 0.3
        ob.data.update()
        select(ob, [])
        return stand_in_of(OBJECT_OT_limit_rebind, method=method)

    return case


def to_unbind():
    ob, _hair = bound("NODES")
    ob.data.vertices[0].co.z += 0.3
    ob.data.update()
    bpy.context.view_layer.update()
    select(ob, [])
    return stand_in_of(OBJECT_OT_limit_unbind, shape="SHOWN")


def to_attach():
    ob = surface()
    things = [bpy.data.objects.new(f"Thing {i}", None) for i in range(5)]
    for i, thing in enumerate(things):
        bpy.context.collection.objects.link(thing)
        thing.location = (0.7 * i, 0.4, 1)
    select(ob, things)
    return stand_in_of(OBJECT_OT_limit_attach)


def to_snap():
    ob = surface()
    hair = scenes.add_hair(ob, per_side=2)
    hair.location.z += 0.3
    select(ob, [hair])
    bpy.context.view_layer.update()
    return stand_in_of(OBJECT_OT_limit_snap)


CASES = {
    "follow by nodes": to_follow("NODES"),
    "follow live": to_follow("LIVE"),
    "rebind by the closest point": to_rebind("NODES", "CLOSEST"),
    "rebind by UV": to_rebind("NODES", "UV"),
    "rebind by face": to_rebind("NODES", "FACE"),
    "rebind live": to_rebind("LIVE", "CLOSEST"),
    "unbind": to_unbind,
    "attach": to_attach,
    "snap": to_snap,
}


@pytest.fixture
def slowly(monkeypatch):
    """What is computed aside stops until the event is set."""
    go_on = threading.Event()

    class SlowJob(Job):
        def __init__(self, work):
            def wait_first(progress):
                wait_for(go_on)
                return work(progress)

            super().__init__(wait_first)

    monkeypatch.setattr(piecewise_job, "Job", SlowJob)
    monkeypatch.setattr(watched_operator, "PATIENCE", 0.05)
    monkeypatch.setattr(watched_operator, "TICK", 0.05)
    yield go_on
    go_on.set()


def in_file():
    return scenes.file_contents(), contents.digest()


@pytest.mark.parametrize("name", CASES)
def test_esc_leaves_everything_as_it_was(name, slowly):
    slowly.set()
    operator, context = CASES[name](), window_context()
    slowly.clear()
    before = in_file()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    assert "ESC: Cancel" in status_text(context)
    assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("A")) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}  # while the work still stands
    context.workspace.status_text_set.assert_called_with(None)
    assert "Cancelled" in operator.report.call_args.args[1]
    assert in_file() == before
    slowly.set()


@pytest.mark.parametrize("name", CASES)
def test_waiting_changes_no_result(name, slowly):
    slowly.set()
    operator = CASES[name]()
    assert operator.execute(bpy.context) == {"FINISHED"}
    expected = contents.digest()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    operator, context = CASES[name](), window_context()
    slowly.clear()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    slowly.set()
    while (result := operator.modal(context, event("TIMER"))) == {"RUNNING_MODAL"}:
        pass
    assert result == {"FINISHED"}
    assert contents.digest() == expected


def test_curves_are_laid_piece_by_piece(monkeypatch):
    fit = fitting.Fit.spline

    def slow_fit(*arguments):
        time.sleep(0.05)
        return fit(*arguments)

    monkeypatch.setattr(fitting.Fit, "spline", slow_fit)
    monkeypatch.setattr(watched_operator, "PATIENCE", 0.01)
    monkeypatch.setattr(watched_operator, "TICK", 0.01)
    ob, cable = surface(), add_cable()
    data = cable.data
    select(ob, [cable])
    before = [tuple(point.co) for spline in data.splines for point in spline.points]

    operator, context = stand_in_of(OBJECT_OT_limit_curve_lay, spline="POLY"), window_context()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    parts = [operator._job.part]
    for _ in range(2):
        assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
        parts.append(operator._job.part)
    assert parts == sorted(set(parts))
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    assert [tuple(point.co) for spline in data.splines for point in spline.points] == before

    operator = stand_in_of(OBJECT_OT_limit_curve_lay, spline="POLY")
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    while (result := operator.modal(context, event("TIMER"))) == {"RUNNING_MODAL"}:
        pass
    assert result == {"FINISHED"}
    assert len(data.splines) == 6


def test_things_that_are_removed_meanwhile_are_missed(slowly):
    slowly.set()
    operator, context = CASES["follow by nodes"](), window_context()
    hair = next(ob for ob in bpy.context.selected_objects if ob.type == "CURVES")
    slowly.clear()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    bpy.data.objects.remove(hair)
    slowly.set()
    while (result := operator.modal(context, event("TIMER"))) == {"RUNNING_MODAL"}:
        pass
    assert result == {"CANCELLED"}
    assert "does not exist any more" in operator.report.call_args.args[1]


def test_work_aside():
    def fail(_progress):
        raise RefusalError("of mine")

    assert at_once(aside(lambda progress: progress(0.5) or "made")) == "made"
    with pytest.raises(RefusalError, match="of mine"):
        at_once(aside(fail))

    reached, go_on, ended = threading.Event(), threading.Event(), threading.Event()

    def work(progress):
        reached.set()
        wait_for(go_on)
        try:
            progress(0.5)
        finally:
            ended.set()

    job = PiecewiseJob(aside(work))
    assert not job.wait(0.01)
    wait_for(reached)
    job.cancel()
    go_on.set()
    wait_for(ended)
    with pytest.raises(CancelledError):
        job.result()
    assert np.isclose(job.part, 0)


def test_groups_that_somebody_makes_meanwhile_stay(slowly):
    slowly.set()
    operator, context = CASES["rebind by the closest point"](), window_context()
    slowly.clear()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    used = bpy.data.node_groups.new("Mine", "GeometryNodeTree")
    bpy.context.active_object.modifiers.new("Mine", "NODES").node_group = used
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    assert "Mine" in bpy.data.node_groups
