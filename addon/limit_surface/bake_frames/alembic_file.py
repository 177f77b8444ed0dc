# SPDX-License-Identifier: GPL-3.0-or-later
"""Alembic files of Blender, rewritten so that equal contents are equal bytes.

Two things change from run to run: the date, and the flag `meshtype` of polygons, which Blender
takes from memory that it has not set. The date becomes a fixed one and the flag true. Because equal
values are stored once, the flag moves all that follows it, so the file is written anew. Its
containers (Ogawa) are groups, which list the positions of their children, and blocks of data.
"""

from __future__ import annotations

import hashlib
import mmap
import re
import struct
from pathlib import Path
from typing import BinaryIO, NamedTuple

from ..errors import RefusalError

_MAGIC = b"Ogawa\xff\x00\x01"
_DATA = 1 << 63  # marks a position as that of data
_NUMBER = struct.Struct("<Q")

# children of the root
_OBJECTS, _METADATA = 2, 3
_DATE = re.compile(rb"(?<=_ai_DateWritten=)[^;]*")
_EPOCH = b"Thu Jan  1 00:00:00 1970"

# the first header of the properties among which the flag is, and the value true with its key
_FLAG_HEADER = bytes.fromhex("011c00000108") + b"meshtype"
_TRUE = bytes.fromhex("16fe7483905cce7a85670e43e4678877") + b"\x01"

_KEY_SIZE = 16  # each value begins with a digest of the rest
_DIGESTS_SIZE = 32  # two digests end the headers of an object: of its properties, of its children


def normalize(path: Path) -> None:
    """Rewrites the file. Raises RefusalError where it is no Alembic file that is complete."""
    new = path.with_name(f"{path.name}.new")
    try:
        with (
            path.open("rb") as file,
            mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as contents,
            new.open("wb") as target,
        ):
            _Rewriter(contents, target).run()
        new.replace(path)
    except (struct.error, ValueError) as error:
        raise RefusalError(f"Blender has written an incomplete Alembic file: {error}") from error
    finally:
        new.unlink(missing_ok=True)


class _Part(NamedTuple):
    position: int
    digest: bytes


class _Rewriter:
    def __init__(self, contents: mmap.mmap, target: BinaryIO) -> None:
        self._contents = contents
        self._target = target
        self._written: dict[int, _Part] = {}  # by the position in the old file

    def run(self) -> None:
        if self._contents[: len(_MAGIC)] != _MAGIC:
            raise ValueError("it is not in Ogawa format")
        self._target.write(self._contents[:16])
        new = []
        for i, old in enumerate(self._children(self._number(8))):
            if i == _OBJECTS:
                self._check_alone(old)
                new.append(self._object(old))
            elif i == _METADATA:
                new.append(self._data(_DATE.sub(_EPOCH, self._bytes(old))))
            else:
                new.append(self._copy(old))
        position = self._group(new).position
        self._target.seek(8)
        self._target.write(_NUMBER.pack(position))

    def _check_alone(self, old: int) -> None:
        """Raises RefusalError where there is more than one object below the root."""
        _properties, *below, _headers = self._children(old)
        if len(below) > 1:
            raise RefusalError(
                "Blender has written other objects into the file, too, because a script adds or "
                "removes data in depsgraph_update_post: disable the script, or use --format npz"
            )

    def _object(self, old: int) -> _Part:
        """Copies an object: its properties, the objects below it, and their headers."""
        properties, *below, headers = self._children(old)
        new = [self._properties(properties), *map(self._object, below)]
        digests = new[0].digest
        digests += _digest(*(part.digest for part in new[1:])) if below else bytes(_KEY_SIZE)
        new.append(self._data(self._bytes(headers)[:-_DIGESTS_SIZE] + digests))
        return self._group(new)

    def _properties(self, old: int) -> _Part:
        """Copies properties: groups of their own, and their headers."""
        children = self._children(old)
        if not children:
            return self._group([])
        *properties, headers = children
        new = []
        if self._bytes(headers).startswith(_FLAG_HEADER):
            new.append(self._group([self._data(_TRUE)]))
        new += [self._properties_or_values(part) for part in properties[len(new) :]]
        return self._group([*new, self._copy(headers)])

    def _properties_or_values(self, old: int) -> _Part:
        children = self._children(old)
        if any(child & _DATA == 0 for child in children):
            return self._properties(old)
        return self._copy(old)

    def _copy(self, old: int) -> _Part:
        if old not in self._written:
            if old & _DATA:
                self._written[old] = self._data(self._bytes(old))
            else:
                self._written[old] = self._group([self._copy(c) for c in self._children(old)])
        return self._written[old]

    def _data(self, contents: bytes) -> _Part:
        if not contents:
            return _Part(_DATA, _digest(b"data"))
        position = self._target.tell()
        self._target.write(_NUMBER.pack(len(contents)))
        self._target.write(contents)
        return _Part(position | _DATA, _digest(contents))

    def _group(self, children: list[_Part]) -> _Part:
        digest = _digest(*(child.digest for child in children))
        if not children:
            return _Part(0, digest)
        position = self._target.tell()
        numbers = [len(children), *(child.position for child in children)]
        self._target.write(b"".join(map(_NUMBER.pack, numbers)))
        return _Part(position, digest)

    def _children(self, group: int) -> list[int]:
        if group == 0:
            return []
        count = self._number(group)
        return list(struct.unpack_from(f"<{count}Q", self._contents, group + _NUMBER.size))

    def _bytes(self, data: int) -> bytes:
        position = data & ~_DATA
        if position == 0:
            return b""
        begin = position + _NUMBER.size
        end = begin + self._number(position)
        if end > len(self._contents):
            raise ValueError(f"what begins at byte {position} goes beyond its end")
        return self._contents[begin:end]

    def _number(self, position: int) -> int:
        found: int = _NUMBER.unpack_from(self._contents, position)[0]
        return found


def _digest(*parts: bytes) -> bytes:
    return hashlib.md5(b"".join(parts), usedforsecurity=False).digest()
