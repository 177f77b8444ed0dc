# SPDX-License-Identifier: GPL-3.0-or-later
"""How many an operator would make on the active mesh, for panels to show.

Drawing may change nothing in the file, but reading a cage does for a moment: so the count is only
asked for while drawing, found a little later, and drawn then. Adding up over the surface runs in a
thread.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from .. import cage, native
from ..errors import RefusalError
from ..job import Job
from . import properties, region
from .density import DensityChoice
from .mask import MaskChoice
from .spread import Spread

PAUSE = 0.2  # seconds until something is looked at that was asked for, or waited for


@dataclass(frozen=True)
class _Asked:
    surface: str  # the object's name
    density: DensityChoice
    mask: MaskChoice


class LiveCount:
    """Of one region at a time: the last that was asked for."""

    def __init__(self) -> None:
        self._asked: _Asked | None = None
        self._region: region.Region | None = None
        self._trouble = ""
        self._job: Job | None = None
        self._is_stale = False

    def text(self, asked: _Asked, spread: Spread, noun: str) -> str:
        if asked != self._asked:
            self.forget()
            self._asked = asked
        if self._trouble:
            return ""
        if self._region is None or self._is_stale:
            self._ask()
        if self._region is None:
            return "..."
        expected = spread.expected(self._region)
        about = "" if expected.is_exact else "about "
        return f"{about}{expected.count:,} {noun}"

    def forget(self) -> None:
        if self._job:
            self._job.cancel()
        self._asked = self._region = self._job = None
        self._trouble, self._is_stale = "", False

    def notice(self, changed: set[str]) -> None:
        """These have changed."""
        if self._asked and (self._asked.surface in changed or self._asked.density.image in changed):
            self._is_stale, self._trouble = True, ""

    def look(self) -> float | None:
        """What a timer calls: seconds until the next call, or None."""
        if self._asked is None:
            return None
        if self._job is None:
            try:
                self._read()
            except (RefusalError, *native.errors) as error:
                self._trouble = str(error)
                _redraw()
                return None
        if not self._job.is_done:
            return PAUSE
        self._region = self._job.result()
        self._job = None
        _redraw()
        return None

    def _ask(self) -> None:
        if self._job is None and not bpy.app.timers.is_registered(self.look):
            bpy.app.timers.register(self.look, first_interval=PAUSE)

    def _read(self) -> None:
        asked, self._is_stale = self._asked, False
        ob = bpy.data.objects.get(asked.surface)
        if ob is None:
            raise RefusalError(f"{asked.surface} is not there any more")
        depsgraph = bpy.context.evaluated_depsgraph_get()
        found = region.read(ob, depsgraph, asked.density, asked.mask)

        def add_up(_progress: object) -> region.Region:
            found.sums  # noqa: B018 - kept there
            return found

        self._job = Job(add_up)
        self._job.start()


_live_count = LiveCount()


def text(ob: bpy.types.Object, settings: bpy.types.OperatorProperties, noun: str) -> str:
    """Nothing where there is no telling."""
    asked = _Asked(ob.name, properties.density_choice(settings), properties.mask_choice(settings))
    try:
        return _live_count.text(asked, properties.spread(settings), noun)
    except RefusalError:
        return ""


@bpy.app.handlers.persistent
def _notice(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if not cage.is_busy():
        _live_count.notice({update.id.name for update in depsgraph.updates})


@bpy.app.handlers.persistent
def _forget(*_arguments: object) -> None:
    _live_count.forget()


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


_HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, _notice),
    (bpy.app.handlers.undo_post, _forget),
    (bpy.app.handlers.redo_post, _forget),
    (bpy.app.handlers.load_post, _forget),
)


def attach_handlers() -> None:
    for handlers, handler in _HANDLERS:
        handlers.append(handler)


def detach_handlers() -> None:
    _live_count.forget()
    for handlers, handler in _HANDLERS:
        handlers.remove(handler)
