# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a USD file is complete: Blender's exporter does not say where a disk was full."""

from __future__ import annotations

import os
from pathlib import Path

from ..errors import RefusalError

_BINARY = b"PXR-USDC"
_HEADER = 24  # bytes: the mark, eight bytes of the version, and where the table of contents begins
_TEXT = b"#usda"


def check_complete(path: Path) -> None:
    """Raises RefusalError for a file that is cut off. A binary one ends with its table of contents,
    whose place its header gives; one of text ends with a closed brace that begins its line.
    """
    if not path.is_file() or not _is_complete(path):
        raise RefusalError(f"{path.name} was not written completely: the disk may be full")


def _is_complete(path: Path) -> bool:
    size = path.stat().st_size
    with path.open("rb") as file:
        header = file.read(_HEADER)
        if header.startswith(_BINARY):
            if len(header) < _HEADER:
                return False
            begin = int.from_bytes(header[16:24], "little")
            file.seek(min(begin, size))
            contents = file.read()
            # a number of sections of 32 bytes each
            return len(contents) >= 8 and len(contents) == 8 + 32 * int.from_bytes(
                contents[:8], "little"
            )
        file.seek(max(0, size - 64), os.SEEK_SET)
        return header.startswith(_TEXT) and file.read().rstrip().endswith(b"\n}")
