# SPDX-License-Identifier: GPL-3.0-or-later
"""Long projecting while a user waits: if it is cancelled, it has changed nothing."""

import threading
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import numpy as np
import projection_truth as truth
import pytest
import scenes
from limit_surface.errors import CancelledError
from limit_surface.project_image import decal_job, properties, texture_job
from limit_surface.tasks import watched_operator as watched_module
from limit_surface.tasks.watched_operator import WatchedOperator
from stand_ins import status_text, window_context
from waiting import wait_for

OPERATOR = "OBJECT_OT_limit_project_image"


def waiting_operator(**chosen):
    """Returns a stand-in in plain Python, because Blender makes no operators without a window, and
    a context whose window only records calls.
    """
    kind = getattr(bpy.types, OPERATOR)
    own = ("start", "finish", "invoke", "draw", "too_large", "cancelled")
    cls = type("StandIn", (WatchedOperator,), {name: getattr(kind, name) for name in own})
    operator = cls()
    operator.bl_rna = bpy.ops.object.limit_project_image.get_rna_type()
    for p in operator.bl_rna.properties:
        is_vector = getattr(p, "array_length", 0)
        value = tuple(p.default_array) if is_vector else getattr(p, "default", None)
        setattr(operator, p.identifier, chosen.get(p.identifier, value))
    operator.properties = operator
    operator.report, operator.layout = MagicMock(), MagicMock()
    return operator, window_context()


@pytest.fixture
def slowly(monkeypatch):
    """Both kinds of work stop half way until the event is set."""
    go_on = threading.Event()

    def delayed(work):
        def wait(self, progress):
            progress(0.5)
            wait_for(go_on)
            return work(self, progress)

        return wait

    for job in (texture_job, decal_job):
        monkeypatch.setattr(job.Order, "work", delayed(job.Order.work))
    monkeypatch.setattr(watched_module, "PATIENCE", 0.01)
    yield go_on
    go_on.set()


def event(kind):
    return SimpleNamespace(type=kind, value="PRESS")


def scene_to_paint():
    ob = scenes.grid_with_holes()
    scenes.add_uv_map(ob, lambda p: p[:, :2] / (5, 4))
    truth.add_camera((2.5, 2, 9), (2.5, 2, 0))
    bpy.data.images.new("Shown", 8, 8, alpha=True).generated_type = "COLOR_GRID"
    target = bpy.data.images.new("Target", 64, 64, alpha=True)
    scenes.activate(ob)
    return target


@pytest.mark.parametrize("mode", ["TEXTURE", "DECAL"])
def test_long_work_can_be_cancelled(slowly, mode):
    target = scene_to_paint()
    before = truth.pixels(target), scenes.file_contents()
    operator, context = waiting_operator(
        image="Shown", mode=mode, output="EXISTING", target="Target"
    )
    operator.invoke(context, event("LEFTMOUSE"))
    assert context.window_manager.invoke_props_dialog.call_args.args == (operator,)
    assert operator.execute(context) == {"RUNNING_MODAL"}
    job = operator._job
    assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
    assert "Projecting Shown: 50%" in status_text(context)
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    assert operator.report.call_args.args[1] == "Cancelled: nothing was projected"
    slowly.set()
    wait_for(job)
    with pytest.raises(CancelledError):
        job.result()
    np.testing.assert_array_equal(truth.pixels(target), before[0])
    assert scenes.file_contents() == before[1]


@pytest.mark.parametrize("gone", ["Target", "Shown"])
def test_what_is_removed_meanwhile_is_told_of(slowly, gone):
    scene_to_paint()
    mode = "TEXTURE" if gone == "Target" else "DECAL"
    operator, context = waiting_operator(
        image="Shown", mode=mode, output="EXISTING", target="Target"
    )
    operator.invoke(context, event("LEFTMOUSE"))
    operator.execute(context)
    bpy.data.images.remove(bpy.data.images[gone])
    slowly.set()
    wait_for(operator._job)
    assert operator.modal(context, event("TIMER")) == {"CANCELLED"}
    operator.report.assert_called_once_with({"ERROR"}, f"{gone} does not exist any more")


def test_targets_of_another_size_meanwhile_are_told_of(slowly):
    target = scene_to_paint()
    operator, context = waiting_operator(image="Shown", output="EXISTING", target="Target")
    operator.invoke(context, event("LEFTMOUSE"))
    operator.execute(context)
    target.scale(32, 32)
    slowly.set()
    wait_for(operator._job)
    assert operator.modal(context, event("TIMER")) == {"CANCELLED"}
    operator.report.assert_called_once_with(
        {"ERROR"}, "The size of Target has changed since the work began: run the operator again"
    )


def shown(**chosen):
    layout = MagicMock()
    rna = bpy.ops.object.limit_project_image.get_rna_type().properties
    values = {p.identifier: chosen.get(p.identifier, getattr(p, "default", "")) for p in rna}
    properties.draw(layout, SimpleNamespace(**values))
    calls = []
    for part in (layout, layout.column()):
        calls += part.prop.call_args_list + part.prop_search.call_args_list
    return {call.args[1] for call in calls}


def test_every_property_is_shown_where_it_counts():
    rna = bpy.ops.object.limit_project_image.get_rna_type().properties
    every = set()
    for source in ("CAMERA", "VIEW", "PLANAR", "BOX", "NORMALS"):
        for mode in ("TEXTURE", "DECAL"):
            for output in ("NEW", "EXISTING"):
                every |= shown(source=source, mode=mode, output=output, use_depth=True)
    assert every == {p.identifier for p in rna if not p.is_hidden and p.identifier != "rna_type"}
    assert "camera" not in shown(source="VIEW")
    assert "width" not in shown(output="EXISTING")
    assert not {"overlap", "occlusion"} & shown(mode="DECAL")
    assert not {"facing", "occlusion"} & shown(source="BOX")
