# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work of every operator, while which somebody changes the file: what would be wrong then is
refused with the reason, and leaves the file as it is; what does not matter is not refused.

Blender calls the operators' methods where there is a window; here stand-ins of plain Python are
called instead.
"""

import threading

import bpy
import contents
import meanwhile_cases as cases
import pytest
from limit_surface.particles import system
from limit_surface.tasks import watched_operator
from limit_surface.tasks.job import Job
from limit_surface.tasks.piecewise_job import PiecewiseJob
from limit_surface.tasks.watched_operator import WatchedOperator
from stand_ins import event, window_context
from waiting import wait_for


@pytest.fixture
def begun(monkeypatch):
    """Returns a function that begins an operator's work, up to the first place at which Blender is
    usable, and returns the function that lets it go on to its end.
    """
    go_on, run = threading.Event(), Job._run

    def slowly(self, show):
        if threading.current_thread() is not threading.main_thread():
            wait_for(go_on)
        run(self, show)

    def begin(name):
        operator = (cases.CASES | cases.MORE_CASES)[name]()
        context = window_context()
        for now in (
            "scene",
            "view_layer",
            "selected_objects",
            "active_object",
        ):  # undo replaces them
            setattr(type(context), now, property(lambda _, now=now: getattr(bpy.context, now)))
        monkeypatch.setattr(Job, "_run", slowly)
        monkeypatch.setattr(watched_operator, "PATIENCE", 0)
        operator._someone_waits = True
        assert operator.execute(context) == {"RUNNING_MODAL"}
        job = operator._job
        if isinstance(job, PiecewiseJob):
            job._step()
            assert not job.is_done

        def end(kind="TIMER"):
            go_on.set()
            if not isinstance(job, PiecewiseJob):
                wait_for(job)
            while (result := operator.modal(context, event(kind))) == {"RUNNING_MODAL"}:
                pass
            context.workspace.status_text_set.assert_called_with(None)
            said = [call.args for call in operator.report.call_args_list]
            return result, " ".join(text for kinds, text in said if kinds != {"INFO"})

        return end

    for name, value in (("_LEAST_TIME", 0), ("_WORK_RATIO", 0), ("_PIECE", 3)):
        monkeypatch.setattr(system, name, value)
    yield begin
    go_on.set()
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def check_refused(end, reason):
    before = contents.digest()
    result, said = end()
    assert result == {"CANCELLED"}
    assert reason in said
    assert contents.digest() == before


REASONS = {
    "faces": "The faces of Holes were changed meanwhile: run the operator again",
    "Edit Mode": "Holes was put into Edit Mode meanwhile: leave it first",
    "removed": "Holes does not exist any more",
    "moved": "Holes was moved meanwhile: run the operator again",
    "UV": "The UV map Flat of Holes was changed meanwhile: run the operator again",
    "UV map": "The UV map Flat of Holes was changed meanwhile: run the operator again",
}


@pytest.mark.parametrize("change", cases.CHANGES)
@pytest.mark.parametrize("case", cases.CASES)
def test_the_surface_changes(begun, case, change):
    end = begun(case)
    cases.CHANGES[change]()
    if case == "particles from hair" and cases.refuses(case, change):
        assert end() == ({"CANCELLED"}, REASONS[change])
        assert not any(ob.particle_systems for ob in bpy.data.objects)
    elif cases.refuses(case, change):
        is_unbound = case == "unbind"  # the surface is read late then
        check_refused(end, "Holes is in Edit Mode" if is_unbound else REASONS[change])
    else:
        namesake = contents.digest().get(f"object {cases.SURFACE}")
        assert end()[0] == {"FINISHED"}
        if change == "swapped":
            assert contents.digest()[f"object {cases.SURFACE}"] == namesake
            assert not bpy.data.objects[cases.SURFACE].children


@pytest.mark.parametrize("change", cases.HAIR_CHANGES)
@pytest.mark.parametrize("case", cases.ON_HAIR)
def test_the_hair_changes(begun, case, change):
    if change in ("strands", "points") and bpy.app.version < (4, 3):
        pytest.skip("Python cannot do that before Blender 4.3")
    end = begun(case)
    cases.HAIR_CHANGES[change]()
    if change in cases.ON_HAIR[case]:
        assert end()[0] == {"FINISHED"}
    else:
        check_refused(end, "does not exist" if change == "removed" else "meanwhile")


@pytest.mark.parametrize(("case", "change", "reason"), cases.OTHERS)
def test_something_else_changes(begun, case, change, reason):
    end = begun(case)
    change()
    if reason:
        check_refused(end, reason)
    else:
        assert end()[0] == {"FINISHED"}


def test_a_renamed_material_is_kept(begun):
    end = begun("limit mesh")
    cases.rename_material()
    end()
    assert bpy.context.active_object.data.materials[0] == bpy.data.materials["Other"]


def test_the_renamed_image_is_painted(begun):
    end = begun("texture")
    cases.swap_targets()
    before = {name: contents.pixels(bpy.data.images[name]) for name in ("Other", "Target")}
    end()
    assert contents.pixels(bpy.data.images["Target"]) == before["Target"]
    assert contents.pixels(bpy.data.images["Other"]) != before["Other"]


def test_edit_mode_that_was_left_again_does_not_matter(begun):
    end = begun("limit mesh")
    cases.enter_edit_mode()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert end()[0] == {"FINISHED"}


@pytest.mark.parametrize("case", cases.CASES)
def test_undo_takes_the_surface_away(begun, case):
    """Undo replaces what Python has held."""
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="Empty")
    end = begun(case)
    bpy.ops.ed.undo_push(message="Scene")
    bpy.ops.ed.undo()
    assert cases.SURFACE not in bpy.data.objects
    if case == "unbind":
        assert end()[0] == {"CANCELLED"}
    else:
        check_refused(end, "does not exist any more")


@pytest.mark.parametrize("case", cases.CASES)
def test_undo_of_something_else(begun, case):
    """It matters to work that goes on with Blender's own data."""
    bpy.context.preferences.edit.use_global_undo = True
    end = begun(case)
    bpy.ops.ed.undo_push(message="Scene")
    bpy.data.objects.new("Other", None)
    bpy.ops.ed.undo_push(message="Other")
    bpy.ops.ed.undo()
    assert "Other" not in bpy.data.objects
    before = contents.digest(saved_only=True)
    result, said = end()
    assert result == {"FINISHED"} or "removed meanwhile" in said
    assert result == {"FINISHED"} or contents.digest(saved_only=True) == before


@pytest.mark.parametrize("case", cases.CASES)
def test_escape_after_the_surface_was_removed(begun, case):
    end = begun(case)
    cases.remove_surface()
    assert end("ESC")[0] == {"CANCELLED"}


def test_every_operator_with_long_work_is_here():
    found = set()
    for make in (cases.CASES | cases.MORE_CASES).values():
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        found.add(make().bl_rna.identifier)
    assert found == {cls.bl_rna.identifier for cls in watched(WatchedOperator)}


def watched(base):
    for cls in base.__subclasses__():
        if issubclass(cls, bpy.types.Operator) and cls.is_registered:
            yield cls
        yield from watched(cls)
