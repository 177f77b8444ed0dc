# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a bake: one for each object in each frame, and a record of where they are from.

Several jobs may write to the same folder at once, also from several machines. A file gets its name
when it is complete, so a frame of an object is there or it is not.
"""

from __future__ import annotations

import json
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ..errors import RefusalError

# unfinished files begin so; one that a killed job has left can be deleted
PARTIAL = ".partial"
RECORD = "bake.json"
# the key of the record for a checksum of the .blend file
CONTENTS = "file_sha256"


class FrameFiles:
    def __init__(self, folder: Path, suffix: str) -> None:
        self._folder = folder
        self._suffix = suffix

    def prepare(self, record: dict[str, str], overwrite: bool) -> None:
        """Makes the folder and writes the record. Raises RefusalError where the folder holds frames
        with another record, which must not be mixed with new ones. With `overwrite`, the contents
        of the .blend file may be others.
        """
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            there = self._claim(record)
            if not isinstance(there, dict):
                raise RefusalError(f"{self._record} is not the record of a bake: delete it")
            differ = sorted(key for key in record if there.get(key) != record[key])
            if overwrite and differ == [CONTENTS]:
                self._replace(record)
                return
        except OSError as error:
            raise RefusalError(f"cannot write to {self._folder}: {error.strerror}") from error
        if CONTENTS in differ and CONTENTS not in there:  # of an earlier version of the extension
            differ.remove(CONTENTS)
        if differ:
            reasons = "; ".join(_difference(key, there.get(key), record[key]) for key in differ)
            raise RefusalError(
                f"{self._folder} holds another bake ({reasons}): give another folder, or delete "
                "that bake"
            )

    def path(self, name: str, frame: int) -> Path:
        sign = "-" if frame < 0 else ""
        return self._folder / f"{name}.{sign}{abs(frame):04d}{self._suffix}"

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

    def _replace(self, record: dict[str, str]) -> None:
        with _partial(self._record) as partial:
            _write(partial, record)
            partial.replace(self._record)

    def _claim(self, record: dict[str, str]) -> Any:
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


def _difference(key: str, there: object, here: str) -> str:
    if key == CONTENTS:
        return "the .blend file has changed since, or is another one: --overwrite replaces all"
    return f"{key} {there}, not {here}"


def _write(path: Path, record: dict[str, str]) -> None:
    path.write_text(json.dumps(record, indent=2, sort_keys=True) + "\n")
    _save(path)


@contextmanager
def _partial(path: Path) -> Iterator[Path]:
    """Yields a name that no other job uses, and leaves no file of that name."""
    job = f"{socket.gethostname()}-{os.getpid()}"
    partial = path.with_name(f"{PARTIAL}-{job}-{path.name}")
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
