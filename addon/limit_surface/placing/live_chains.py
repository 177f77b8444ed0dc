# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces whose shapes depend on things that follow other surfaces live: hair on a garment that
follows a body, for instance. In each frame the garment is posed first, then the hair.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import bpy

from .dependencies import shaped_by

#: Objects that follow live, by the surface that they follow
Followers = Mapping[bpy.types.Object, list[bpy.types.Object]]


class Chains:
    """What the surfaces of a scene depend on. Other dependencies than those by way of modifiers
    are not seen.
    """

    def __init__(self, followers: Followers) -> None:
        self._followers = followers
        # a single surface cannot depend on what follows another one
        surfaces = followers if len(followers) > 1 else ()
        self._needed = {s: {ob.data for ob in shaped_by(s)} for s in surfaces}

    def in_order(self) -> Iterable[bpy.types.Object]:
        """Yields the surfaces: each after those whose followers it depends on, where there is such
        an order.
        """
        waiting = list(self._followers)
        while waiting:
            moving = {ob.data for surface in waiting for ob in self._followers[surface]}
            ready = next((s for s in waiting if not self._depends(s, moving)), waiting[0])
            waiting.remove(ready)
            yield ready

    def _depends(self, surface: bpy.types.Object, moving: set[bpy.types.ID]) -> bool:
        own = {ob.data for ob in self._followers[surface]}
        return self.depends(surface, moving - own)

    def depends(self, surface: bpy.types.Object, moved: set[bpy.types.ID]) -> bool:
        """Tells whether the surface's shape depends on one of these data-blocks."""
        return not self._needed.get(surface, set()).isdisjoint(moved)
