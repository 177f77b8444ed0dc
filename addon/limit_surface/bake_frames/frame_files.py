# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a bake: one for each object in each frame, and a record of where they are from.

Several jobs may write to the same folder at once, also from several machines. A file gets its name
when it is complete, so a frame of an object is there or it is not.
"""

from __future__ import annotations

import json
import os
import re
import socket
from collections.abc import Iterator, Mapping, Set
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ..counting import counted
from ..errors import RefusalError
from ..tasks import file_names

# unfinished files begin so; one that a killed job has left can be deleted
PARTIAL = ".partial"
RECORD = "bake.json"
# the keys of the record for the .blend file's name, its checksum, and those of the files it links
FILE = "file"
CONTENTS = "file_sha256"
LIBRARIES = "libraries_sha256"

Record = Mapping[str, str | dict[str, str]]

#: Bytes of a file's name on most systems
_LONGEST_NAME = 255

_FRAME = re.compile(r".+\.-?\d{4,}\.(?:abc|usda?|npz)")


class FrameFiles:
    def __init__(self, folder: Path, suffix: str) -> None:
        self._folder = folder
        self._suffix = suffix

    def prepare(self, record: Record, replaced: Set[Path]) -> None:
        """Makes the folder and writes the record. Raises RefusalError where the folder holds frames
        with another record, or without one, which must not be mixed with new ones. The .blend file
        and what it links may have other contents if each frame in the folder is to be `replaced`.
        """
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            # in this order: frames of a job that runs beside this one come after its record
            has_frames = bool(self._frames())
            has_record = self._record.exists()
            if has_frames and not has_record:
                if self._frames() - replaced:
                    raise RefusalError(
                        f"{self._folder} holds frames but no {RECORD}, which would say from which "
                        "file they come: delete the frames, give another folder, or replace all "
                        "frames in it with --overwrite"
                    )
                self._replace(record, replaced, True)
                return
            there = self._claim(record)
            if not isinstance(there, dict):
                raise RefusalError(
                    f"{self._record} is damaged, so it cannot be known from which file the frames "
                    f"in {self._folder} come: delete {RECORD} and the frames, or give another "
                    "folder"
                )
            # records of earlier versions of the extension lack some checksums
            unknown = {key for key in (CONTENTS, LIBRARIES) if key not in there}
            differ = {key for key in record if there.get(key) != record[key]} - unknown
            is_unnamed = not (record[FILE] and there.get(FILE))
            if is_unnamed and (has_frames or FILE in differ):
                # Files that were never saved cannot be told from each other.
                differ = (differ - {FILE}) | {CONTENTS}
            if replaced and (differ or unknown) and differ <= {CONTENTS, LIBRARIES}:
                self._replace(record, replaced, bool(differ))
                return
        except OSError as error:
            raise RefusalError(f"cannot write to {self._folder}: {error.strerror}") from error
        if differ == {CONTENTS} and not record[FILE]:
            raise RefusalError(
                f"{self._folder} holds a bake. Whether it is one of the open file cannot be known, "
                "because this file was never saved: save it first, and give another folder, or "
                "replace all frames in the folder with --overwrite"
            )
        if differ:
            reasons = "; ".join(_difference(key, there, record) for key in sorted(differ))
            raise RefusalError(
                f"{self._folder} holds another bake ({reasons}): give another folder, or delete "
                "that bake"
            )

    def path(self, name: str, frame: int) -> Path:
        sign = "-" if frame < 0 else ""
        return self._folder / f"{name}.{sign}{abs(frame):04d}{self._suffix}"

    def check_name(self, name: str, frames: range, whose: str) -> None:
        """Raises RefusalError where the name is too long for files of these frames."""
        longest = max((self.path(name, frame).name for frame in (frames[0], frames[-1])), key=len)
        size = len(longest.encode())
        if size > _LONGEST_NAME:
            raise RefusalError(
                f"the name of the object {whose} is too long for files: {longest} has {size} "
                f"bytes, and {_LONGEST_NAME} are allowed. Give the object a shorter name"
            )

    @contextmanager
    def written(self, path: Path) -> Iterator[Path]:
        """Yields another path, to which the file is to be written. When the context ends well, it
        gets its name; otherwise it is removed.
        """
        with _partial(path) as partial:
            yield partial
            if not partial.is_file():
                raise RefusalError("Blender's exporter has written nothing")
            _save(partial)
            partial.replace(path)

    @property
    def _record(self) -> Path:
        return self._folder / RECORD

    def _frames(self) -> set[Path]:
        return {p for p in self._folder.iterdir() if _FRAME.fullmatch(p.name) and p.is_file()}

    def _replace(self, record: Record, replaced: Set[Path], has_changed: bool) -> None:
        """Deletes all frames, and writes the record. So a job that is ended before it has written
        all frames anew leaves none of the old ones.
        """
        old = self._frames()
        rest = sorted(old - replaced)
        if rest and not has_changed:
            return
        if rest:
            raise RefusalError(
                f"{self._folder} holds {counted(len(rest), 'files')} that this job would not "
                f"replace, such as {rest[0].name}, and the .blend file or a file that it links "
                "has changed since they were written: bake all frames and objects in one job, "
                "give another folder, or delete the old files first"
            )
        for path in old:
            path.unlink()
        with _partial(self._record) as partial:
            _write(partial, record)
            partial.replace(self._record)

    def _claim(self, record: Record) -> Any:
        """Writes the record, unless there is one, and returns the one that is there."""
        with _partial(self._record) as partial:
            _write(partial, record)
            try:
                os.link(partial, self._record)  # fails where the file exists
            except FileExistsError:
                pass
            except OSError:  # a file system without links
                if not self._record.exists():
                    partial.replace(self._record)
        try:
            return json.loads(self._record.read_text())
        except ValueError:
            return None


def _difference(key: str, there: Record, here: Record) -> str:
    was, now = there.get(key), here[key]
    if key == CONTENTS:
        if not here[FILE]:
            return "the open file was never saved"
        if not there.get(FILE):
            return "its .blend file had not been saved: --overwrite replaces all"
        return "the .blend file has changed since, or is another one: --overwrite replaces all"
    if key == LIBRARIES and isinstance(was, dict) and isinstance(now, dict):
        names = sorted(n for n in was.keys() | now.keys() if was.get(n) != now.get(n))
        return f"linked files have changed since: {', '.join(names)}; --overwrite replaces all"
    return f"{key} {was}, not {now}"


def _write(path: Path, record: Record) -> None:
    path.write_text(json.dumps(record, indent=2, sort_keys=True) + "\n")
    _save(path)


@contextmanager
def _partial(path: Path) -> Iterator[Path]:
    """Yields a name that no other job uses, and leaves no file of that name."""
    job = f"{socket.gethostname()}-{os.getpid()}"
    # without the whole name, because that may be as long as names can be
    partial = path.with_name(f"{PARTIAL}-{job}-{file_names.number(path.name)}{path.suffix}")
    try:
        yield partial
    finally:
        with suppress(FileNotFoundError):
            partial.unlink()


def _save(path: Path) -> None:
    """Waits until the file's contents are on the disk: a crash of the machine must not leave a name
    without contents.
    """
    with path.open("rb+") as file:
        os.fsync(file.fileno())
