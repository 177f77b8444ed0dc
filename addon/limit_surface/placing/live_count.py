# SPDX-License-Identifier: GPL-3.0-or-later
"""The number of things that an operator would make on the active mesh, for panels to show.

Drawing must not change the file, but reading a cage changes it for a moment. So drawing only asks
for the number; a timer finds it a little later, and it is drawn then. Sums over the surface are
calculated in a thread.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from .. import native
from ..errors import RefusalError
from ..reading import cage
from ..tasks.job import Job, Progress
from ..tasks.object_keys import ObjectKey
from . import border_properties, distribution_properties, region
from .border import BorderChoice
from .density import DensityChoice
from .distribution import Distribution
from .followers import ground_of
from .mask import MaskChoice

# seconds until the timer looks at a new question, or again at an answer that is not ready
PAUSE = 0.2


@dataclass(frozen=True)
class Question:
    """What has to be read from Blender in order to calculate the number."""

    surface: ObjectKey
    density: DensityChoice
    mask: MaskChoice
    border: BorderChoice | None

    def read(self) -> region.Region:
        ob = self.surface.find()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        return region.read(ob, depsgraph, self.density, self.mask, border=self.border)


class LiveCount:
    """Answers the latest question, and answers it again when the file has changed."""

    _question: Question | None
    _region: region.Region | None
    _job: Job | None
    _trouble: str
    _is_stale: bool

    def __init__(self) -> None:
        # always the same bound method, by which Blender identifies the timer
        self._look_later = self._look
        self.forget()

    def text(self, question: Question, distribution: Distribution, noun: str) -> str:
        """The number as text, or the reason why it is not known."""
        if question != self._question:
            self.forget()
            self._question = question
        if self._is_stale and not bpy.app.timers.is_registered(self._look_later):
            bpy.app.timers.register(self._look_later, first_interval=PAUSE)
        if self._trouble:
            return self._trouble
        if self._region is None:
            return "Counting"
        expected = distribution.expected(self._region)
        about = "" if expected.is_exact else "About "
        return f"{about}{expected.count:,} {noun}"

    def notice(self, changed: set[str]) -> None:
        """Is called when data-blocks of these names have changed."""
        question = self._question
        if question and {question.surface.name, question.density.image} & changed:
            self._is_stale = True

    def forget(self) -> None:
        self._question = None
        self._region = None
        self._job = None
        self._trouble = ""
        self._is_stale = True

    def stop(self) -> None:
        """Ends the timer."""
        if bpy.app.timers.is_registered(self._look_later):
            bpy.app.timers.unregister(self._look_later)

    def _look(self) -> float | None:
        """Is called by a timer, and returns the seconds until the next call, or None."""
        if self._question is None:
            return None
        try:
            if self._job is None:
                self._is_stale = False
                self._job = _add_up(self._question.read())
            if not self._job.is_done:
                return PAUSE
            self._region, self._trouble = self._job.result(), ""
        except native.refusals as error:
            self._trouble = native.sentence(error)
        self._job = None
        _redraw()
        return None


def _add_up(found: region.Region) -> Job:
    def work(_progress: Progress) -> region.Region:
        found.measure()
        return found

    job = Job(work)
    job.start()
    return job


_counts: dict[str, LiveCount] = {}


def text(context: bpy.types.Context, settings: bpy.types.OperatorProperties, noun: str) -> str:
    """Returns the text for the panel about things of that name."""
    if context.screen and context.screen.is_animation_playing:
        return "Not counted during playback"
    question = Question(
        ObjectKey.of(ground_of(context.active_object)),
        distribution_properties.density_choice(settings),
        distribution_properties.mask_choice(settings),
        border_properties.choice(settings),
    )
    try:
        count = _counts.setdefault(noun, LiveCount())
        return count.text(question, distribution_properties.distribution(settings), noun)
    except RefusalError as error:
        return str(error)


@bpy.app.handlers.persistent
def _notice(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if _counts and not cage.is_busy():
        # Reading the surface makes Blender name all objects once more, without such a change.
        changed = {
            update.id.name
            for update in depsgraph.updates
            if update.is_updated_geometry
            or update.is_updated_transform
            or update.id.id_type == "IMAGE"
        }
        for count in _counts.values():
            count.notice(changed)


@bpy.app.handlers.persistent
def _forget(*_arguments: object) -> None:
    _counts.clear()


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
    for count in _counts.values():
        count.stop()
    _counts.clear()
    for handlers, handler in _HANDLERS:
        handlers.remove(handler)
