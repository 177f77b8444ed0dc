# SPDX-License-Identifier: GPL-3.0-or-later
"""Long baking while a user waits: if it is cancelled, it has made nothing."""

import threading
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import pytest
import scenes
import sculpts
from limit_surface.bake_displacement import operator as baking_operator
from limit_surface.errors import CancelledError
from limit_surface.images.texture_operator import TextureOperator
from limit_surface.tasks import watched_operator as watched_module
from waiting import wait_for


@pytest.fixture
def waiting():
    """Returns a stand-in in plain Python, because Blender makes no operators without a window, and
    a context whose window only records calls.
    """
    base = scenes.flat_grid(3)
    scenes.add_subsurf(base)
    scenes.add_uv_map(base, lambda at: at[:, :2] / 4 + 0.1)
    sculpts.subdivided_copy(base, 1)
    kind = baking_operator.OBJECT_OT_limit_bake_displacement
    own = {name: value for name, value in vars(kind).items() if not name.startswith("__")}
    operator = type("StandIn", (TextureOperator,), own)()
    for p in bpy.ops.object.limit_bake_displacement.get_rna_type().properties:
        setattr(operator, p.identifier, getattr(p, "default", None))
    operator.target, operator.width, operator.height = "Sculpt", 32, 32
    operator.properties, operator.report = operator, MagicMock()
    context = MagicMock(wraps=bpy.context)
    context.active_object, context.scene = base, bpy.context.scene
    context.window_manager, context.workspace = MagicMock(), MagicMock()
    operator._someone_waits = True
    return operator, context


@pytest.fixture
def let_go(monkeypatch):
    """The work stops half way until the event is set."""
    event, measure = threading.Event(), baking_operator.measure

    def slowly(request, progress):
        progress(0.5)
        wait_for(event)
        return measure(request, progress)

    monkeypatch.setattr(baking_operator, "measure", slowly)
    monkeypatch.setattr(watched_module, "PATIENCE", 0.01)
    yield event
    event.set()


def event_of(kind):
    return SimpleNamespace(type=kind, value="PRESS")


def test_it_can_be_cancelled(waiting, let_go):
    operator, context = waiting
    before = scenes.file_contents()
    assert operator.execute(context) == {"RUNNING_MODAL"}
    job = operator._job
    assert operator.modal(context, event_of("TIMER")) == {"RUNNING_MODAL"}
    assert operator.modal(context, event_of("ESC")) == {"CANCELLED"}
    let_go.set()
    wait_for(job)
    with pytest.raises(CancelledError):
        job.result()
    assert scenes.file_contents() == before
    assert "Cancelled: no image was made" in str(operator.report.call_args)


def test_it_ends_with_an_image(waiting, let_go):
    operator, context = waiting
    assert operator.execute(context) == {"RUNNING_MODAL"}
    let_go.set()
    wait_for(operator._job)
    assert operator.modal(context, event_of("TIMER")) == {"FINISHED"}
    assert tuple(bpy.data.images["Flat Displacement"].size) == (32, 32)


def test_a_mesh_that_is_gone_by_then(waiting, let_go):
    operator, context = waiting
    assert operator.execute(context) == {"RUNNING_MODAL"}
    bpy.data.objects.remove(bpy.data.objects["Flat"])
    before = scenes.file_contents()
    let_go.set()
    wait_for(operator._job)
    assert operator.modal(context, event_of("TIMER")) == {"CANCELLED"}
    assert scenes.file_contents() == before
    assert "Flat does not exist any more" in str(operator.report.call_args)


def test_the_dialog_shows_what_counts(waiting):
    operator, _ = waiting
    operator.layout = MagicMock()
    operator.summary = "one\ntwo"
    shown = {}
    for kind, mode in (("UV", "VECTOR"), ("PTEX", "SCALAR")):
        operator.layout.reset_mock()
        operator.layout_kind, operator.mode = kind, mode
        operator.draw(bpy.context)
        column = operator.layout.column.return_value
        shown[kind] = {call.args[1] for call in column.prop.call_args_list}
    assert shown["UV"] - shown["PTEX"] == {
        "space", "width", "height", "margin", "use_tiles", "overlap",
    }  # fmt: skip
    assert shown["PTEX"] - shown["UV"] == {"direction", "max_distance", "face_resolution"}
    column = operator.layout.column.return_value
    labels = [call.kwargs["text"] for call in column.label.call_args_list]
    assert labels == ["one", "two"]
