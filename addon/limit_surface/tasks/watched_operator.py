# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators whose work may take long.

The steps of such an operator, in the order in which they run, with the method that takes each step
and the class that provides it:

1. `poll`: WatchedOperator, for operators on the active mesh in Object Mode.
2. `invoke`, where a user has chosen the operator: WatchedOperator remembers that somebody waits and
   goes on with step 3. A TextureOperator shows its dialog first, which leads to step 3. A
   ScatterOperator reads its order first: the user has to confirm what is very large, which leads to
   step 3; with anything else it goes on with step 5.
3. `execute`: WatchedOperator calls `start`, and reports refusals as errors. This is where scripts,
   the redo panel and confirmed dialogs begin.
4. `start`: the operator reads from Blender what the work needs, names the objects that this came
   from to `rely_on`, and hands a job to `watch`. A PiecewiseJob may call `rely_on` in its pieces.
5. `watch`: WatchedOperator runs the job. It is done at once for scripts; where somebody waits, it
   runs in a thread, and `modal` looks after it until it is done or ESC ends it by `cancel`. A
   PiecewiseJob (`tasks/piecewise_job.py`), which works on Blender's own data, runs piece by piece
   in `modal` instead.
6. `modal`: where objects that the work relies on have changed meanwhile, WatchedOperator refuses
   the result.
7. `finish`: the operator gets what the job has made, and is the first to change anything.

`placing/scatter_operator.py` says how a ScatterOperator divides steps 4 to 7 further.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, Any

import bpy

from .. import native
from .job import Job
from .polling import mesh_in_object_mode
from .progress import TICK, Waiting, progress_bar
from .properties import SummaryProperty, check_numbers
from .running import Running
from .unchanged import Unchanged

#: Where a user waits, work that is not done after so many seconds shows its progress while Blender
#: stays usable.
PATIENCE = 0.3

VIEW_NAVIGATION = {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "NDOF_MOTION"}


class WatchedOperator(SummaryProperty):
    """Mixin for operators with long work. Where a user waits, the work runs in a thread while
    Blender stays usable, until it is done or ESC ends it. In scripts it runs at once. Refusals are
    reported as errors.

    A subclass provides `start` and `finish`, and says what it relies on.
    """

    if TYPE_CHECKING:  # of bpy.types.Operator, the other base of its subclasses
        report: Callable[[set[str], str], None]
        layout: bpy.types.UILayout
        properties: bpy.types.OperatorProperties
        bl_label: str

    _someone_waits = False
    _job: Job | None = None
    _relied_on: tuple[Unchanged, ...] = ()

    @property
    def too_large(self) -> str:
        return "There is not enough memory"

    @property
    def cancelled(self) -> str:
        return "Cancelled"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return mesh_in_object_mode(cls, context, context.active_object)

    def start(self, context: bpy.types.Context) -> set[str]:
        raise NotImplementedError

    def finish(self, context: bpy.types.Context, made: Any) -> set[str]:
        raise NotImplementedError

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self._someone_waits = True
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self._guarded(self._start, context)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, self.cancelled)
            return {"CANCELLED"}
        if event.type in VIEW_NAVIGATION:
            return {"PASS_THROUGH"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        job = self._job
        assert job is not None
        is_done = job.advance(TICK, self._check_relied_on)
        self._waiting.show(job.part)
        if not is_done:
            return {"RUNNING_MODAL"}
        self._end_waiting()
        return self._guarded(self._finish, context, self._taken_job())

    def cancel(self, _context: bpy.types.Context) -> None:
        """Is called at ESC, or when another file is loaded, Blender quits or the extension is
        disabled while the work runs. ESC in a dialog calls it before there is a job.
        """
        job = self._taken_job()
        if job is not None:
            job.cancel()
            self._end_waiting()

    def watch(self, context: bpy.types.Context, job: Job, text: str) -> set[str]:
        someone_waits, self._someone_waits = self._someone_waits, False
        if not (someone_waits and context.window):
            with progress_bar(context.window_manager) as show:
                job.run(show)
            return self._finish(context, job)
        job.start()
        if job.wait(PATIENCE):
            return self._finish(context, job)
        self._job, self._waiting = job, Waiting(context, text)
        self._running = Running(context, self.cancel)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def rely_on(
        self,
        *objects: bpy.types.Object,
        data: bool = True,
        shape: bool = False,
        placed: bool = False,
        named: Collection[str] = (),
    ) -> None:
        """Has the result refused where these objects are not what they are now, before it is used.
        `tasks/unchanged.py` says what counts.
        """
        self._relied_on += tuple(
            Unchanged(ob, data=data, shape=shape, placed=placed, named=named) for ob in objects
        )

    def _end_waiting(self) -> None:
        self._running.over()
        self._waiting.end()

    def _check_relied_on(self) -> None:
        for each in self._relied_on:
            each.check()

    def _taken_job(self) -> Job | None:
        """Returns the job and forgets it: Blender keeps operators for the redo panel, so they must
        not keep results.
        """
        job, self._job = self._job, None
        self._relied_on = ()
        return job

    def _start(self, context: bpy.types.Context) -> set[str]:
        self._relied_on = ()
        check_numbers(self.properties)
        return self.start(context)

    def _finish(self, context: bpy.types.Context, job: Job) -> set[str]:
        self._relied_on = ()
        return self.finish(context, job.result())

    def _guarded(self, step: Callable[..., set[str]], *arguments: Any) -> set[str]:
        try:
            return step(*arguments)
        except native.refusals as error:
            reason = native.sentence(error)
        except MemoryError:
            reason = self.too_large
        self.report({"ERROR"}, reason)
        return {"CANCELLED"}
