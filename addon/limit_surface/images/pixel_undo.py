# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo and redo of pixels that operators have written.

Blender's undo steps hold an image's properties, but not its pixels. So each write stores a mark in
a property of the image, and saves the pixels before and after it in Blender's temporary folder.
After an undo or a redo the mark tells which of these pixels the image has to show. Where the mark
has not changed, Blender may still have dropped pixels that were not saved; then the image gets them
again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from uuid import uuid4

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from . import image_tiles, temporary_files

MOST_KEPT = 8 << 30  # in bytes; the oldest pixels are dropped where more would be stored
COMPARED = 1 << 20  # numbers compared at a time, so that no large array is made for it

_GONE = "gone"  # without a mark: the image does not exist at this point of the undo history


@dataclass(frozen=True, eq=False)
class _Kept:
    files: Mapping[int, Path]  # the pixels by tile

    @classmethod
    def of(cls, tiles: Mapping[int, np.ndarray], mark: str, whose: str) -> _Kept:
        """Stores the pixels of the image `whose`. Raises RefusalError where that is impossible."""
        folder = Path(bpy.app.tempdir)
        kept = cls({number: folder / f"limit_surface_{mark}_{number}.npy" for number in tiles})
        try:
            with temporary_files.written(f"The pixels of {whose}", " for undo"):
                for number, pixels in tiles.items():
                    np.save(kept.files[number], np.ascontiguousarray(pixels, np.float32))
        except BaseException:
            kept.drop()  # the last file may have been written in part
            raise
        return kept

    def holds(self, tiles: Mapping[int, np.ndarray]) -> bool:
        """Tells whether these are the very pixels, bit by bit."""
        return tiles.keys() == self.files.keys() and all(
            file.exists() and _same_bits(np.load(file, mmap_mode="r"), tiles[number])
            for number, file in self.files.items()
        )

    @property
    def size(self) -> int:
        return sum(file.stat().st_size for file in self.files.values() if file.exists())

    def show(self, image: bpy.types.Image) -> None:
        if not self.files:  # there were no pixels, mostly because the image's file was missing
            image.reload()
            return
        if image_tiles.shown_from_files(image, self.holds):
            return  # the image is not marked as changed then
        tiles = {number: np.load(file) for number, file in self.files.items() if file.exists()}
        if tiles.keys() == self.files.keys():
            image_tiles.write_some(image, tiles)

    def drop(self) -> None:
        for file in self.files.values():
            file.unlink(missing_ok=True)


@dataclass(frozen=True)
class _Write:
    onto: str | None  # the mark that the image had before the write
    before: _Kept  # often what an earlier write has left, which is then stored once
    after: _Kept


@dataclass(frozen=True)
class _Shown:
    """The mark and the pixels that an image has now."""

    mark: str | None
    kept: _Kept | None


_writes: dict[str, _Write] = {}  # the writes by mark, the oldest first
_shown: dict[int, _Shown] = {}  # what is shown, by the image's session_uid
_unsaved: set[int] = set()  # images that held unsaved pixels before an undo or a redo


@contextmanager
def recorded(image: bpy.types.Image) -> Iterator[Callable[[Mapping[int, np.ndarray]], None]]:
    """Records a change of the image's pixels. If the change fails, the pixels are restored. Yields
    a function that stores the pixels of all tiles after the change, and has to be called.
    """
    mark, onto = uuid4().hex, image.get(ids.PIXELS_MARK)
    now = image_tiles.read_all(image) if image_tiles.has_pixels(image) else {}
    stored: list[_Kept] = []
    shown = _shown.get(image.session_uid)
    if shown and shown.kept and shown.kept.holds(now):
        before = shown.kept
    else:
        before = _Kept.of(now, f"{mark}_before", image.name)
    del now

    def tell(tiles: Mapping[int, np.ndarray]) -> None:
        stored.append(_Kept.of(tiles, f"{mark}_after", image.name))

    try:
        yield tell
        (after,) = stored
    except BaseException:
        try:
            before.show(image)
        finally:
            _drop([before, *stored])
        raise
    _writes[mark] = _Write(onto, before, after)
    image[ids.PIXELS_MARK] = mark
    _shown[image.session_uid] = _Shown(mark, after)
    _drop_oldest()


def record_rounded(image: bpy.types.Image) -> None:
    """Records that the pixels of the last write were rounded since, because the image shows them
    from the file to which they were saved.
    """
    shown = _shown.get(image.session_uid)
    if not shown or shown.mark not in _writes or shown.mark != image.get(ids.PIXELS_MARK):
        return
    exact = _writes[shown.mark].after
    with suppress(RefusalError):  # the image has changed already; redo gives what is not rounded
        now = image_tiles.read_all(image)
        if exact.holds(now):
            return
        after = _Kept.of(now, f"{shown.mark}_rounded", image.name)
        _writes[shown.mark] = replace(_writes[shown.mark], after=after)
        _shown[image.session_uid] = _Shown(shown.mark, after)
        _drop([exact])


def attach_handlers() -> None:
    for handlers, function in _HANDLERS:
        handlers.append(function)


def detach_handlers() -> None:
    for handlers, function in _HANDLERS:
        handlers.remove(function)
    _forget()


@bpy.app.handlers.persistent
def _look(*_scene: object) -> None:
    _unsaved.clear()
    _unsaved.update(
        i.session_uid for i in bpy.data.images if i.session_uid in _shown and i.is_dirty
    )


@bpy.app.handlers.persistent
def _follow(*_scene: object) -> None:
    there = {image.session_uid: image for image in bpy.data.images}
    for uid, shown in _shown.items():
        image = there.get(uid)
        mark = image.get(ids.PIXELS_MARK) if image else _GONE
        kept = shown.kept if mark == shown.mark else _pixels_at(mark, shown.mark)
        is_dropped = image and uid in _unsaved and not image.is_dirty
        if image and kept and (mark != shown.mark or is_dropped):
            kept.show(image)
        _shown[uid] = _Shown(mark, kept)


def _pixels_at(mark: str | None, shown: str | None) -> _Kept | None:
    """Returns the pixels that lead from the state of one mark to that of another: those before the
    first write between them to go back, those after the last one to go ahead.
    """
    while shown in _writes:
        write = _writes[shown]
        if write.onto == mark:
            return write.before
        shown = write.onto
    return _writes[mark].after if mark in _writes else None


def _same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    if a.shape != b.shape or a.dtype != b.dtype:
        return False
    a, b = (np.ascontiguousarray(of).reshape(-1).view(np.uint32) for of in (a, b))
    return all(
        np.array_equal(a[begin : begin + COMPARED], b[begin : begin + COMPARED])
        for begin in range(0, len(a), COMPARED)
    )


def _kept_by_writes() -> set[_Kept]:
    return {kept for write in _writes.values() for kept in (write.before, write.after)}


def _drop(kept: list[_Kept]) -> None:
    """Removes the files of pixels that no write needs."""
    needed = _kept_by_writes()
    for one in kept:
        if one not in needed:
            one.drop()


def _drop_oldest() -> None:
    while len(_writes) > 1 and sum(kept.size for kept in _kept_by_writes()) > MOST_KEPT:
        oldest = _writes.pop(next(iter(_writes)))
        _drop([oldest.before, oldest.after])


@bpy.app.handlers.persistent
def _forget(*_file: object) -> None:
    kept = list(_kept_by_writes())
    _writes.clear()
    _drop(kept)
    _shown.clear()


_HANDLERS = (
    (bpy.app.handlers.undo_pre, _look),
    (bpy.app.handlers.redo_pre, _look),
    (bpy.app.handlers.undo_post, _follow),
    (bpy.app.handlers.redo_post, _follow),
    (bpy.app.handlers.load_post, _forget),
)
