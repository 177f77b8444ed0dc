# SPDX-License-Identifier: GPL-3.0-or-later
"""The 3D viewport in which a modal operator was started: where the mouse looks, and the texts."""

from __future__ import annotations

import bpy

from ..tasks.status_bar import StatusText
from . import ray


class View:
    def __init__(self, context: bpy.types.Context) -> None:
        self._area, self._status = context.area, StatusText(context)

    @property
    def exists(self) -> bool:
        """Tells whether the area is there. Blender does not say when it is closed, and what is read
        of a closed one is anything.
        """
        return any(self._area == area for screen in bpy.data.screens for area in screen.areas)

    def sight(self, event: bpy.types.Event) -> ray.Ray | None:
        """Returns the ray through the mouse; None where the mouse is beside the viewport."""
        x, y = event.mouse_x, event.mouse_y
        region = region_at(self._area, x, y)
        return ray.through(region, region.data, x, y) if region else None

    def is_over(self, event: bpy.types.Event) -> bool:
        return region_at(self._area, event.mouse_x, event.mouse_y) is not None

    def show_keys(self, text: str) -> None:
        self._status.show(text)

    def show_state(self, text: str) -> None:
        self._area.header_text_set(text)

    def redraw(self) -> None:
        self._area.tag_redraw()

    def clear(self) -> None:
        self._status.clear()
        if self.exists:
            self._area.header_text_set(None)
            self._area.tag_redraw()


def region_at(area: bpy.types.Area, x: float, y: float) -> bpy.types.Region | None:
    """Returns the region that shows the scene under a place of the window. Sidebars and headers may
    overlap it; the scene is not under the mouse there, even where they are transparent.
    """
    found = [region for region in area.regions if _holds(region, x, y)]
    if any(region.type != "WINDOW" for region in found):
        return None
    return found[0] if found else None


def _holds(region: bpy.types.Region, x: float, y: float) -> bool:
    if region.width <= 1 or region.height <= 1:  # it is hidden
        return False
    return 0 <= x - region.x < region.width and 0 <= y - region.y < region.height
