# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys by which a task finds its objects, materials, images and collections again when it is done.

While a task runs, Blender may remove them or move them in memory, so no reference is kept. Users
may rename them, and give their names to others: Blender's own number of a data-block tells it from
all others as long as the file is open, also after undo.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Self

import bpy

from ..errors import RefusalError


class _Named(NamedTuple):
    name: str
    # The path of the library's file; None for the open file. It distinguishes data-blocks of the
    # same name in several files.
    library: str | None
    number: int  # the session_uid

    @classmethod
    def of(cls, block: bpy.types.ID) -> Self:
        block = block.original  # evaluated copies have no number
        path = block.library.filepath if block.library else None
        return cls(block.name, path, block.session_uid)

    def among(self, blocks: Any) -> Any:
        """Returns the data-block, or None if it has been removed."""
        named = blocks.get((self.name, self.library))
        if named is not None and named.session_uid == self.number:
            return named
        renamed = next((each for each in blocks if each.session_uid == self.number), None)
        if renamed is None and self.library is not None:
            return named  # its library has been loaded anew, which gives it another number
        return renamed

    def required(self, blocks: Any) -> Any:
        """Raises RefusalError if the data-block has been removed."""
        found = self.among(blocks)
        if found is None:
            raise RefusalError(f"{self.name} does not exist any more")
        return found


class ObjectKey(_Named):
    """Of an object."""

    def find(self) -> bpy.types.Object:
        """Raises RefusalError if the object has been removed."""
        return self.required(bpy.data.objects)


class ImageKey(_Named):
    """Of an image."""

    def find(self) -> bpy.types.Image:
        """Raises RefusalError if the image has been removed."""
        return self.required(bpy.data.images)


class CollectionKey(_Named):
    """Of a collection."""

    def find(self) -> bpy.types.Collection:
        """Raises RefusalError if the collection has been removed."""
        return self.required(bpy.data.collections)


class MaterialKey(_Named):
    """Of a material."""

    def find(self) -> bpy.types.Material | None:
        """Returns None if the material has been removed."""
        return self.among(bpy.data.materials)
