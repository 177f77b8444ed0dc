# SPDX-License-Identifier: GPL-3.0-or-later
"""The files that a bake is made from: the .blend file and those that it links."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

import bpy

from ..errors import RefusalError


def check() -> None:
    """Raises RefusalError where something is missing that the file links: Blender shows what
    depends on it without it, at rest for example, and says nothing. Refused are also changes that
    are not saved, because no checksum of a file would tell them from others.
    """
    for prop in bpy.data.bl_rna.properties:
        for block in getattr(bpy.data, prop.identifier) if prop.type == "COLLECTION" else ():
            if block.is_missing and block.library:
                raise RefusalError(
                    f"{block.name} is missing: it cannot be read from {block.library.filepath}"
                )
    for library, path in _libraries():
        if not path.is_file():
            raise RefusalError(
                f"the library {library.filepath} is missing: there is no file {path}"
            )
    if _has_unsaved_changes():
        raise RefusalError(
            "the .blend file has changes that are not saved. Save it first: the bake records which "
            "file its frames come from, by a checksum of the saved file"
        )


def checksum() -> str:
    """Returns a checksum of the .blend file; nothing where there is none. Jobs of one bake may find
    the file at different paths.
    """
    path = Path(bpy.data.filepath)
    return _checksum(path) if path.is_file() else ""


def library_checksums() -> dict[str, str]:
    """Returns checksums of the files that are linked, by their names without folders."""
    found: dict[str, set[str]] = {}
    for _library, path in _libraries():
        found.setdefault(path.name, set()).add(_checksum(path))
    return {name: " ".join(sorted(found[name])) for name in sorted(found)}


def _libraries() -> Iterator[tuple[bpy.types.Library, Path]]:
    """Yields libraries that are files of their own."""
    for library in bpy.data.libraries:
        if not library.packed_file:
            yield library, Path(bpy.path.abspath(library.filepath, library=library.parent))


def _has_unsaved_changes() -> bool:
    # Without a window Blender does not know: some versions take each file for changed.
    return not bpy.app.background and bool(bpy.data.is_dirty)


def _checksum(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
