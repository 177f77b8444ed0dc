# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators whose work may take long."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy

from .. import native
from ..errors import RefusalError
from .job import Job
from .progress import Waiting, progress_bar

#: Work lets the user wait, and watch it, from here on
PATIENCE = 0.3  # seconds

VIEW_NAVIGATION = {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "NDOF_MOTION"}


class WatchedOperator:
    """Mixin: where somebody waits, long work goes on beside Blender until it is done or ESC ends
    it; scripts get it done at once. Refusals are reported as errors.

    A subclass's `start` reads what the work needs and hands a job to `watch`; `finish` gets what
    the job has made, and is the first to change anything.
    """

    too_large = "Not enough memory"
    cancelled = "Cancelled"
    _someone_waits = False
    _job: Job | None = None

    def start(self, context: bpy.types.Context) -> set[str]:
        raise NotImplementedError

    def finish(self, context: bpy.types.Context, made: Any) -> set[str]:
        raise NotImplementedError

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self._someone_waits = True
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self._guarded(self.start, context)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, self.cancelled)
            return {"CANCELLED"}
        if event.type in VIEW_NAVIGATION:
            return {"PASS_THROUGH"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        self._waiting.show(self._job.part)
        if not self._job.is_done:
            return {"RUNNING_MODAL"}
        self._waiting.end()
        return self._guarded(self._finish, context, self._taken_job())

    def cancel(self, _context: bpy.types.Context) -> None:
        """By ESC; or another file is loaded, or Blender quits, while somebody waits. Or by ESC in
        a dialog, before there is a job."""
        job = self._taken_job()
        if job is not None:
            job.cancel()
            self._waiting.end()

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
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def _taken_job(self) -> Job | None:
        """Blender keeps operators, for the redo panel: not what they have made."""
        job, self._job = self._job, None
        return job

    def _finish(self, context: bpy.types.Context, job: Job) -> set[str]:
        return self.finish(context, job.result())

    def _guarded(self, step: Callable[..., set[str]], *arguments: Any) -> set[str]:
        try:
            return step(*arguments)
        except (RefusalError, *native.errors) as error:
            reason = str(error)
        except MemoryError:
            reason = self.too_large
        self.report({"ERROR"}, reason)
        return {"CANCELLED"}
