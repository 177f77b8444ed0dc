# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces whose shapes depend on things that follow other surfaces live: hair on a garment that
follows a body, for instance. In each frame the garment is posed first, then the hair.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

import bpy

from .followers import sharers

#: Objects that follow live, by the surface that they follow
Followers = Mapping[bpy.types.Object, list[bpy.types.Object]]
#: The data-blocks by way of which one object depends on another
_CARRIERS = {
    *("OBJECT", "COLLECTION", "NODETREE"),
    *("ARMATURE", "CURVE", "KEY", "LATTICE", "MESH", "PARTICLE"),  # what drivers may change
}


class Chains:
    """Which surfaces depend on what follows others, by whatever relation."""

    def __init__(self, followers: Followers) -> None:
        self._followers = followers
        self._needed: dict[bpy.types.Object, set[bpy.types.ID]] = {s: set() for s in followers}
        if len(followers) < 2:  # a single surface cannot depend on what follows another one
            return
        things = [ob for each in followers.values() for ob in each]
        starts: dict[bpy.types.Object, set[bpy.types.ID]] = {
            ob: {ob, *sharers(ob), ob.data} for ob in things
        }
        users = _users_of(set().union(*starts.values()))
        for ob in things:
            for surface in _reached(starts[ob], users).intersection(followers):
                self._needed[surface].add(ob.data)

    def in_order(self) -> Iterator[bpy.types.Object]:
        """Yields the surfaces: each after those whose followers it depends on, where there is such
        an order.
        """
        waiting = list(self._followers)
        while waiting:
            moving = {ob.data for surface in waiting for ob in self._followers[surface]}
            ready = next((s for s in waiting if not self._waits(s, moving)), waiting[0])
            waiting.remove(ready)
            yield ready

    def _waits(self, surface: bpy.types.Object, moving: set[bpy.types.ID]) -> bool:
        return self.depends(surface, moving.difference(self._data_on(surface)))

    def needed_by(self, surface: bpy.types.Object) -> Collection[bpy.types.ID]:
        """Returns the data-blocks that follow live and on which the surface's shape depends."""
        return self._needed[surface]

    def depends(self, surface: bpy.types.Object, moved: Collection[bpy.types.ID]) -> bool:
        """Tells whether the surface's shape depends on one of these data-blocks."""
        return not self._needed[surface].isdisjoint(moved)

    def behind(self, surfaces: Collection[bpy.types.Object]) -> set[bpy.types.Object]:
        """Returns the surfaces that may change when things on these ones move, and these."""
        found, waiting = set(surfaces), list(surfaces)
        while waiting:
            moving = self._data_on(waiting.pop())
            new = {s for s in self._followers if s not in found and self.depends(s, moving)}
            found |= new
            waiting.extend(new)
        return found

    def _data_on(self, surface: bpy.types.Object) -> set[bpy.types.ID]:
        return {ob.data for ob in self._followers[surface]}


def _users_of(blocks: set[bpy.types.ID]) -> dict[bpy.types.ID, set[bpy.types.ID]]:
    """Returns what uses these data-blocks, what uses that, and so on. Blender looks at all of the
    file for each step: a millisecond for some thousand objects.
    """
    users: dict[bpy.types.ID, set[bpy.types.ID]] = {}
    waiting = set(blocks)
    while waiting:
        found = bpy.data.user_map(subset=waiting, value_types=_CARRIERS)
        users.update(found)
        waiting = set().union(*found.values()).difference(users)
    return users


def _reached(
    starts: set[bpy.types.ID], users: Mapping[bpy.types.ID, set[bpy.types.ID]]
) -> set[bpy.types.ID]:
    reached, waiting = set(starts), list(starts)
    while waiting:
        new = users.get(waiting.pop(), set()).difference(reached)
        reached |= new
        waiting.extend(new)
    return reached
