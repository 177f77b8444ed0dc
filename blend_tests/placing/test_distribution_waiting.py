# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work: it is confirmed, shown, and cancelled by ESC, after which nothing is left of it.

Blender calls these methods of the operators where there is a window; here a stand-in of plain
Python that has them is called instead.
"""

import threading

import bmesh
import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.errors import CancelledError
from limit_surface.placing import scatter_operator
from limit_surface.reading import attributes
from limit_surface.tasks import watched_operator
from limit_surface.tasks.job import Job, part_of
from stand_ins import OPERATORS, event, stand_in, status_text, window_context
from waiting import LIMIT, wait_for


def subdivided_cross():
    """Adds a mesh about whose modifier nobody is asked."""
    ob = scenes.cross()
    scenes.add_subsurf(ob)
    return ob


@pytest.fixture
def slowly(monkeypatch):
    """Evaluation stops until the event is set."""
    go_on = threading.Event()
    evaluate = scatter_operator.Ground.evaluate

    def wait(self, face, uv):
        wait_for(go_on)
        return evaluate(self, face, uv)

    monkeypatch.setattr(scatter_operator.Ground, "evaluate", wait)
    monkeypatch.setattr(watched_operator, "PATIENCE", 0.01)
    yield go_on
    go_on.set()


@pytest.mark.parametrize("name", OPERATORS)
def test_long_work_is_waited_for(name, slowly):
    subdivided_cross()
    operator, context = stand_in(name, per_side=4), window_context()
    before = scenes.file_contents()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    context.window_manager.modal_handler_add.assert_called_once_with(operator)
    assert "ESC: Cancel" in status_text(context)
    for what in ("TIMER", "MOUSEMOVE", "A"):
        assert operator.modal(context, event(what)) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("WHEELUPMOUSE")) == {"PASS_THROUGH"}
    assert scenes.file_contents() == before
    slowly.set()
    wait_for(operator._job)
    assert operator.modal(context, event("TIMER")) == {"FINISHED"}
    context.workspace.status_text_set.assert_called_with(None)
    timer = context.window_manager.event_timer_add.return_value
    context.window_manager.event_timer_remove.assert_called_once_with(timer)
    made = bpy.context.active_object
    assert made.parent.name == "Cross"
    in_time = (scenes.add_hair if name == "hair" else scenes.add_points)(made.parent)
    for attribute in (ids.FACE, ids.UV, ids.REST_ROOT, "position"):
        np.testing.assert_array_equal(
            attributes.read(made.data, attribute), attributes.read(in_time.data, attribute)
        )


@pytest.mark.parametrize("name", OPERATORS)
def test_esc_leaves_nothing(name, slowly):
    subdivided_cross()
    before, active = scenes.file_contents(), bpy.context.active_object
    operator, context = stand_in(name), window_context()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    job = operator._job
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    context.workspace.status_text_set.assert_called_with(None)
    context.window_manager.event_timer_remove.assert_called_once()
    slowly.set()
    wait_for(job)
    with pytest.raises(CancelledError):
        job.result()
    assert scenes.file_contents() == before
    assert bpy.context.active_object == active
    assert "Cancelled" in operator.report.call_args.args[1]


def test_a_new_file_while_somebody_waits(slowly):
    subdivided_cross()
    operator, context = stand_in("hair"), window_context()
    operator.invoke(context, None)
    job = operator._job
    operator.cancel(context)
    slowly.set()
    wait_for(job)
    with pytest.raises(CancelledError):
        job.result()


@pytest.mark.parametrize("what", ["faces", "Edit Mode"])
def test_the_surface_is_changed_meanwhile(slowly, what):
    """By another window, a script or another add-on."""
    ob = subdivided_cross()
    operator, context = stand_in("hair", per_side=3), window_context()
    operator.invoke(context, None)
    if what == "faces":
        changed = bmesh.new()
        changed.from_mesh(ob.data)
        bmesh.ops.subdivide_edges(changed, edges=changed.edges, cuts=1, use_grid_fill=True)
        changed.to_mesh(ob.data)
        changed.free()
        reason = "The faces of Cross were changed meanwhile: run the operator again"
    else:
        bpy.ops.object.mode_set(mode="EDIT")
        reason = "Cross was put into Edit Mode meanwhile: leave it first"
    slowly.set()
    wait_for(operator._job)
    assert operator.modal(context, event("TIMER")) == {"CANCELLED"}
    operator.report.assert_called_with({"ERROR"}, reason)
    assert not bpy.data.hair_curves


def test_the_surface_is_gone_meanwhile(slowly):
    ob = subdivided_cross()
    operator, context = stand_in("hair", per_side=3), window_context()
    operator.invoke(context, None)
    bpy.data.objects.remove(ob)
    slowly.set()
    wait_for(operator._job)
    assert operator.modal(context, event("TIMER")) == {"CANCELLED"}
    operator.report.assert_called_with({"ERROR"}, "Cross does not exist any more")
    assert not bpy.data.hair_curves


def failed(monkeypatch, error):
    """Returns an operator whose work ends in an error, and its context."""
    subdivided_cross()

    def fail(*_arguments):
        raise error

    def wait_too_long(self, seconds):
        wait_for(self._done)
        return seconds > 1

    monkeypatch.setattr(scatter_operator.Ground, "evaluate", fail)
    operator, context = stand_in("hair"), window_context()
    monkeypatch.setattr(Job, "wait", wait_too_long)
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    wait_for(operator._job)
    return operator, context


def test_memory_that_runs_out_in_the_thread(monkeypatch):
    operator, context = failed(monkeypatch, MemoryError())
    before = scenes.file_contents()
    assert operator.modal(context, event("TIMER")) == {"CANCELLED"}
    assert "There is not enough memory" in operator.report.call_args.args[1]
    assert scenes.file_contents() == before


def test_more_than_blender_holds_is_refused_even_if_large_counts_are_allowed():
    subdivided_cross()
    before = scenes.file_contents()
    chosen = {"distribution": "UNIFORM", "count": 2**31 - 1, "points": 5, "allow_large": True}
    operator = stand_in("hair", **chosen)
    assert operator.invoke(window_context(), None) == {"CANCELLED"}
    assert "more than the 2,147,483,647 that Blender holds" in operator.report.call_args.args[1]
    assert scenes.file_contents() == before


def test_mistakes_in_the_thread_keep_their_traceback(monkeypatch):
    operator, context = failed(monkeypatch, ZeroDivisionError("of mine"))
    with pytest.raises(ZeroDivisionError, match="of mine"):
        operator.modal(context, event("TIMER"))


def test_short_work_is_not_waited_for(monkeypatch):
    monkeypatch.setattr(watched_operator, "PATIENCE", LIMIT)
    subdivided_cross()
    operator, context = stand_in("hair", per_side=3), window_context()
    assert operator.invoke(context, None) == {"FINISHED"}
    context.window_manager.modal_handler_add.assert_not_called()
    context.workspace.status_text_set.assert_not_called()
    assert len(bpy.context.active_object.data.curves) == 45


def test_scripts_wait_without_events(slowly):
    slowly.set()
    subdivided_cross()
    operator, context = stand_in("hair", per_side=3), window_context()
    assert operator.execute(context) == {"FINISHED"}
    context.window_manager.modal_handler_add.assert_not_called()
    context.window_manager.progress_end.assert_called_once()


def test_large_counts_are_asked_about_first(slowly):
    subdivided_cross()
    operator, context = stand_in("hair", per_side=1000), window_context()
    operator.invoke(context, None)
    confirm = context.window_manager.invoke_confirm
    assert confirm.call_args.kwargs["message"].startswith("Make 5,000,000 strands of 5 points")
    known = bpy.types.WindowManager.bl_rna.functions["invoke_confirm"].parameters.keys()
    assert set(confirm.call_args.kwargs) <= set(known)
    assert operator.allow_large  # for the execution that follows the confirmation
    operator.per_side = 3  # without this the rest of the test would make millions of points
    assert operator.execute(context) == {"RUNNING_MODAL"}
    operator.modal(context, event("ESC"))


def test_estimates_are_called_so_when_asking():
    subdivided_cross()
    operator = stand_in("hair", distribution="BLUE_NOISE", amount="DISTANCE", distance=5e-4)
    context = window_context()
    operator.invoke(context, None)
    message = context.window_manager.invoke_confirm.call_args.kwargs["message"]
    assert message.startswith("Make about ")


def test_progress_goes_from_0_to_1():
    seen = []

    def work(progress):
        part_of(progress, 0, 0.5)(0.5)
        part_of(progress, 0.5, 1)(0.5)
        return "made"

    assert Job(work).run(seen.append) == "made"
    assert seen == [0.25, 0.75, 1.0]


def test_a_cancelled_job_ends_where_it_tells_its_progress():
    reached, halfway, go_on = [], threading.Event(), threading.Event()

    def work(progress):
        for step in range(4):
            progress(step / 4)
            reached.append(step)
            if step == 2:
                halfway.set()
                wait_for(go_on)

    job = Job(work)
    job.start()
    wait_for(halfway)
    job.cancel()
    go_on.set()
    wait_for(job)
    with pytest.raises(CancelledError):
        job.result()
    assert reached == [0, 1, 2]
