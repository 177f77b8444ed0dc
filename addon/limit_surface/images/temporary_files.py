# SPDX-License-Identifier: GPL-3.0-or-later
"""Files in Blender's temporary folder, which may have no room for them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy

from ..errors import RefusalError


@contextmanager
def written(what: str, purpose: str = "") -> Iterator[None]:
    """Raises RefusalError where a file with `what` cannot be written, for example on a full disk.
    It names the folder, which users can change in Blender's preferences.
    """
    try:
        yield
    except OSError as error:
        # numpy does not say why it could write only a part
        reason = error.strerror or "the disk may be full"
        raise RefusalError(
            f"{what} cannot be stored{purpose} in the temporary folder {bpy.app.tempdir}: {reason}"
        ) from error


@contextmanager
def folder(what: str) -> Iterator[Path]:
    """Makes a folder of its own for `what`, which is removed in the end."""
    with written(what):
        made = TemporaryDirectory(dir=bpy.app.tempdir)
    with made as path:
        yield Path(path)
