# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that an operator writes: all of them replace what was there, or none does.

    with file_replacing.all_or_none() as files:
        write(files.beside(first)), write(files.beside(second))
        files.place()
        ...                                                # an error here takes the files back, too

A new file is written beside the one that it replaces, so that it is on the same disk and can take
its place at once. Until the end, what it replaces is kept there, too.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from uuid import uuid4

from ..errors import RefusalError


@dataclass
class _File:
    path: Path
    new: Path
    old: Path  # where the file that is replaced is kept
    had_old: bool = False
    is_placed: bool = False


class Files:
    def __init__(self) -> None:
        self._files: list[_File] = []

    def beside(self, path: str | Path) -> Path:
        """Returns the path at which the file is to be written that will replace the one at
        `path`.
        """
        check(path)
        real = Path(os.path.realpath(path))  # a link goes on leading to its file
        hidden = real.with_name(f".limit_surface_{uuid4().hex}")
        file = _File(real, hidden.with_suffix(real.suffix), hidden.with_suffix(".old"))
        self._files.append(file)
        return file.new

    def place(self) -> None:
        """Puts the files where they belong. Raises RefusalError where that is impossible."""
        for file in self._files:
            try:
                if file.path.exists():
                    with suppress(OSError):  # some file systems have no permissions
                        shutil.copymode(file.path, file.new)
                    os.replace(file.path, file.old)
                    file.had_old = True
                os.replace(file.new, file.path)
                file.is_placed = True
            except OSError as error:
                raise RefusalError(f"{file.path} cannot be written: {error.strerror}") from error

    def take_back(self) -> None:
        for file in self._files:
            file.new.unlink(missing_ok=True)
            if file.had_old:
                os.replace(file.old, file.path)
            elif file.is_placed:
                file.path.unlink(missing_ok=True)

    def forget_old(self) -> None:
        for file in self._files:
            if file.had_old:
                with suppress(OSError):  # the new file is in its place, whatever becomes of this
                    file.old.unlink()


@contextmanager
def all_or_none() -> Iterator[Files]:
    files = Files()
    try:
        yield files
    except BaseException:
        files.take_back()
        raise
    files.forget_old()


def check(path: str | Path) -> None:
    """Raises RefusalError where a file cannot be written at that path."""
    path = Path(os.path.realpath(path))
    if path.is_dir():
        raise RefusalError(f"{path} cannot be written: it is a folder")
    if path.exists() and not os.access(path, os.W_OK):
        raise RefusalError(f"{path} cannot be written: it is protected")
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise RefusalError(f"No files can be written in the folder {path.parent}")
