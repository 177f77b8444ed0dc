# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys by which a task finds its objects and materials again when it is done.

While a task runs, Blender may remove them or move them in memory, so no reference is kept.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy

from ..errors import RefusalError


class ObjectKey(NamedTuple):
    """The name and the library of an object. The library distinguishes it from objects with the
    same name in other files.
    """

    name: str
    library: str | None  # the path of the library's file; None for the open file

    @classmethod
    def of(cls, ob: bpy.types.Object) -> ObjectKey:
        return cls(ob.name, ob.library.filepath if ob.library else None)

    def find(self) -> bpy.types.Object:
        """Raises RefusalError if the object has been removed."""
        ob = bpy.data.objects.get((self.name, self.library))
        if ob is None:
            raise RefusalError(f"{self.name} does not exist any more")
        return ob


class MaterialKey(NamedTuple):
    """The name and the library of a material."""

    name: str
    library: str | None

    @classmethod
    def of(cls, material: bpy.types.Material) -> MaterialKey:
        return cls(material.name, material.library.filepath if material.library else None)

    def find(self) -> bpy.types.Material | None:
        """Returns None if the material has been removed."""
        return bpy.data.materials.get((self.name, self.library))
