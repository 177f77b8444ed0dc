# SPDX-License-Identifier: GPL-3.0-or-later
"""The frames of a bake, one after the other."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import bpy

from .. import ids, native
from ..counting import counted
from ..errors import RefusalError
from ..placing import live_kept
from ..tasks import file_names
from . import bindings, sources
from .arguments import Arguments
from .exporters import Subject
from .frame_files import CONTENTS, FILE, LIBRARIES, FrameFiles

# what has become of a file
WRITTEN, EXISTED, FAILED = "written", "existed", "failed"

# OSError: a full disk, say; RuntimeError: what Blender's exporters report
_TROUBLE: tuple[type[Exception], ...] = (OSError, RuntimeError, *native.refusals)


class Bake:
    """Raises RefusalError where the arguments do not fit the open file."""

    def __init__(self, arguments: Arguments) -> None:
        arguments.format.check()
        sources.check()
        self._arguments = arguments
        self._scene = bpy.context.scene
        self.objects = _find(arguments, self._scene)
        self._names = _file_names(self._scene, self.objects)
        self._files = FrameFiles(arguments.folder, arguments.format.suffix)
        for ob, name in self._names.items():
            self._files.check_name(name, arguments.frames, ob.name)

    @contextmanager
    def at_first_frame(self) -> Iterator[None]:
        with _kept_frame(self._scene):
            self._scene.frame_set(self._arguments.frames[0])
            yield

    def prepare(self) -> None:
        """Raises RefusalError where the folder cannot take the frames."""
        self._files.prepare(
            {
                "blender": bpy.app.version_string,
                FILE: Path(bpy.data.filepath).name,
                "limitsurf": native.version(),
                "scene": self._scene.name,
                CONTENTS: sources.checksum(),
                LIBRARIES: sources.library_checksums(),
            },
            self._planned() if self._arguments.overwrite else frozenset(),
        )

    def _planned(self) -> frozenset[Path]:
        """Returns the files that this job writes."""
        return frozenset(
            self._files.path(name, frame)
            for name in self._names.values()
            for frame in self._arguments.frames
        )

    def run(self, say: Callable[[str], None]) -> int:
        """Writes the files that are not there and returns the number of those that failed."""
        frames = self._arguments.frames
        total: Counter[str] = Counter()
        with _kept_frame(self._scene), _subjects(self._scene, self.objects) as subjects:
            for i, frame in enumerate(frames):
                start = time.perf_counter()
                done, remarks = self._write(frame, subjects)
                total += done
                seconds = time.perf_counter() - start
                text = "; ".join([_count(done), *remarks])
                say(f"frame {frame} ({i + 1} of {len(frames)}, {seconds:.2f} s): {text}")
        say(f"{counted(len(frames), 'frames')} in {self._arguments.folder}: {_count(total)}")
        return total[FAILED]

    def _write(self, frame: int, subjects: list[Subject]) -> tuple[Counter[str], list[str]]:
        """Writes one frame. Returns numbers of files, and remarks."""
        done: Counter[str] = Counter()
        remarks = []
        is_shown = False
        for subject in subjects:
            path = self._files.path(self._names[subject.ob], frame)
            if path.is_file() and not self._arguments.overwrite:
                done[EXISTED] += 1
                continue
            if not is_shown:
                # Handlers are called, as in playback: what follows by handlers is posed by them.
                self._scene.frame_set(frame)
                _show(subjects)
                is_shown = True
            try:
                as_rendered = self._arguments.format.as_rendered
                bindings.check_frame(subject.ob, self._scene, as_rendered)
                moves = live_kept.moves()
                with self._files.written(path) as partial:
                    shows = self._arguments.format.write(partial, subject)
                    bindings.check_posed(subject.ob, self._scene)
                # what was posed as in renders is to be posed as in the viewport for the next object
                is_shown = live_kept.moves() == moves
            except _TROUBLE as error:
                done[FAILED] += 1
                remarks.append(f"{path.name}: {_one_line(error)}")
                continue
            done[WRITTEN] += 1
            if self._arguments.format.as_rendered and subject.ob.hide_render:
                remarks.append(f"{subject.ob.name} is disabled in renders: its file is empty")
            elif not shows:
                remarks.append(f"{subject.ob.name} shows no points: its file is empty")
        return done, remarks


def _find(arguments: Arguments, scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Returns the objects to bake, or raises RefusalError."""
    where = bpy.data.filepath or "no file is open"
    found = []
    for name in arguments.objects:
        same = [ob for ob in scene.objects if ob.name == name]
        if not same:
            raise RefusalError(f"{where}: the scene {scene.name} has no object {name}")
        if len(same) > 1:
            raise RefusalError(f"{len(same)} objects are named {name}, from several files")
        (ob,) = same
        types = arguments.format.types
        if ob.type == "VOLUME" or (types and ob.type not in types):
            kind = ob.bl_rna.properties["type"].enum_items[ob.type].name
            raise RefusalError(
                f"{name} is of the type {kind}, which files of {arguments.format.name} cannot hold"
            )
        if arguments.format.as_rendered and ob.hide_render and not _is_animated(ob):
            raise RefusalError(f"{name} is disabled in renders: its files would be empty")
        found.append(ob)
    return found


def _file_names(
    scene: bpy.types.Scene, objects: Sequence[bpy.types.Object]
) -> dict[bpy.types.Object, str]:
    """Returns how the objects' files are called. They depend on the scene alone, because jobs that
    bake one object each must not take each other's files for their own.
    """
    same = Counter(file_names.allowed(ob.name) for ob in scene.objects)
    names = {}
    for ob in objects:
        name = file_names.allowed(ob.name)
        names[ob] = file_names.different(ob.name) if same[name] > 1 else name
    # some systems ignore the case
    counts = Counter(name.lower() for name in names.values())
    if name := next((name for name, count in counts.items() if count > 1), ""):
        raise RefusalError(f"several objects would be written to the same file {name}")
    return names


def _is_animated(ob: bpy.types.Object) -> bool:
    animation = ob.animation_data
    return bool(animation and (animation.action or animation.nla_tracks or animation.drivers))


@contextmanager
def _kept_frame(scene: bpy.types.Scene) -> Iterator[None]:
    frame, subframe = scene.frame_current, scene.frame_subframe
    try:
        yield
    finally:
        scene.frame_set(frame, subframe=subframe)


@contextmanager
def _subjects(
    scene: bpy.types.Scene, objects: Sequence[bpy.types.Object]
) -> Iterator[list[Subject]]:
    """Yields the objects, each in a collection of its own, and shown in the viewport: neither
    handlers nor numpy would see it otherwise as it is in a frame.
    """
    subjects = []
    hidden = [ob for ob in objects if ob.hide_viewport]
    behind = [ob for ob in objects if ob.name in bpy.context.view_layer.objects and ob.hide_get()]
    try:
        for ob in objects:
            collection = bpy.data.collections.new(ids.BAKE_COLLECTION)
            subjects.append(Subject(ob, collection))
            collection.objects.link(ob)
            scene.collection.children.link(collection)
            ob.hide_viewport = False
            ob.hide_set(False)
        yield subjects
    finally:
        for ob in hidden:
            ob.hide_viewport = True
        for ob in behind:
            ob.hide_set(True)
        for subject in subjects:
            bpy.data.collections.remove(subject.collection)


def _show(subjects: Sequence[Subject]) -> None:
    """Shows objects that their animation has hidden in this frame."""
    hidden = [subject.ob for subject in subjects if subject.ob.hide_viewport]
    for ob in hidden:
        ob.hide_viewport = False
    if hidden:
        bpy.context.view_layer.update()


def _count(done: Counter[str]) -> str:
    return ", ".join(f"{done[key]:,} {key}" for key in (WRITTEN, EXISTED, FAILED) if done[key])


def _one_line(error: Exception) -> str:
    return " ".join(native.sentence(error).split()) or type(error).__name__


def say(text: str) -> None:
    """Prints a line at once: whoever watches a job wants to see how far it is."""
    print(f"limit_surface: {text}", file=sys.stdout, flush=True)
