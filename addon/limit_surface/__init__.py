# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points exactly on the limit surface of subdivided meshes."""

import bpy

from . import hair, points, preferences, ui

_parts = (preferences, hair, points, ui)


def register() -> None:
    for part in _parts:
        for cls in part.classes:
            bpy.utils.register_class(cls)
    ui.append_menus()


def unregister() -> None:
    ui.remove_menus()
    for part in reversed(_parts):
        for cls in reversed(part.classes):
            bpy.utils.unregister_class(cls)
