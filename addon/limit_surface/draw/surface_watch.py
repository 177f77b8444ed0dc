# SPDX-License-Identifier: GPL-3.0-or-later
"""Notices that Blender has evaluated the surface anew: in another frame, or after a change."""

from __future__ import annotations

import bpy

from ..reading import cage
from ..tasks.object_keys import ObjectKey


class SurfaceWatch:
    """Watches until it is closed. Reading the surface at each event would take too long."""

    def __init__(self, surface: bpy.types.Object) -> None:
        self._key = ObjectKey.of(surface)
        self._has_changed = False
        self._lists = (bpy.app.handlers.frame_change_post, bpy.app.handlers.depsgraph_update_post)
        for handlers in self._lists:
            handlers.append(self._notice)

    def close(self) -> None:
        for handlers in self._lists:
            if self._notice in handlers:  # not after another file was opened
                handlers.remove(self._notice)

    def take(self) -> bool:
        """Tells whether the surface may have changed since the last call."""
        found, self._has_changed = self._has_changed, False
        return found

    def _notice(self, _scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        # Reading a surface makes Blender name all objects once more, without such a change.
        if not self._has_changed and not cage.is_busy():
            self._has_changed = any(
                (update.is_updated_geometry or update.is_updated_transform)
                and isinstance(update.id, bpy.types.Object)
                and update.id.original.session_uid == self._key.number
                for update in depsgraph.updates
            )
