# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of what reads a surface: how much follows it, whether it has tables for users' own node
trees, and what has gone wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import bpy

from .. import ids
from ..counting import by_count, counted
from ..nodes import groups
from ..nodes.follow import TILES
from . import all_tiles, capture_place, following, live_children, mending, proxy, seals, tables
from .followers import (
    astray_from,
    followers_of,
    holder_of,
    holders,
    modifier_of,
    strays_of,
    surface_of,
    was_bound,
    why_astray,
)


@dataclass(frozen=True)
class Trouble:
    """Something that has gone wrong, and the operator that puts it right, if it is known."""

    text: str
    remedy: str


@dataclass(frozen=True)
class State:
    surface: bpy.types.Object
    followers: list[bpy.types.Object]
    strays: list[bpy.types.Object]  # they were bound, and have lost their modifier
    samples: bpy.types.Object | None = None  # the table of all tiles
    children: tuple[bpy.types.Object, ...] = ()  # live children that grow on it
    astray: tuple[bpy.types.Object, ...] = ()  # their modifiers name another surface

    @classmethod
    def of(cls, ob: bpy.types.Object | None) -> State | None:
        """Returns the state of the surface that the object is or follows; None where nothing
        follows, no live children grow, and there are no tables of all tiles. These count for the
        surface and its live children alone.
        """
        if ob is None:
            return None
        surface = (surface_of(ob) if was_bound(ob) else live_children.surface_of(ob)) or ob
        children = tuple(live_children.on_surface(surface))
        counts = surface == ob or ob in children
        samples = all_tiles.of_surface(surface) if counts else None
        state = cls(
            surface,
            followers_of(surface),
            strays_of(surface),
            samples,
            children,
            tuple(thing for thing in astray_from(surface) if modifier_of(thing)),
        )
        is_empty = not (state.followers or state.strays or samples or children or state.astray)
        return None if is_empty else state

    @property
    def places(self) -> int:
        """The number of strands and points that follow."""
        stored = [data.attributes for data in holders(self.followers)]
        return sum(len(of[ids.TILE].data) for of in stored if ids.TILE in of)

    @property
    def child_count(self) -> int:
        return sum(live_children.count_of(ob) for ob in self.children)

    @property
    def table_bytes(self) -> int:
        table = tables.of_surface(self.surface)
        return tables.size_in_bytes(table) if table else 0

    @property
    def sample_bytes(self) -> int:
        return tables.size_in_bytes(self.samples) if self.samples else 0

    def troubles(self, signature: str | None) -> list[Trouble]:
        """Returns what has gone wrong. The signature is that of the surface as it is now; without
        it, only what can be seen without an evaluation is named.
        """
        of_children = (
            Trouble(text, ids.REBIND)
            for ob in self.children
            for text in live_children.obstacles(ob, signature)
        )
        changed = list(self._changed_faces(signature)) if signature else []
        rules = self._changed_rules(signature) if signature and not changed else ()
        samples = self.stale_samples(signature) if signature else ()
        broken = [*self._broken(), *self._misled(signature), *self._left_behind()]
        others = [*broken, *rules, *samples, *self._added()]
        if changed:  # Follow refuses then, and Rebind also does what Follow would have done
            others = [replace(t, remedy=_after_changes(t.remedy)) for t in others]
        return [*changed, *others, *of_children]

    def _broken(self) -> Iterator[Trouble]:
        remedy = ids.FOLLOW if self.followers or self.strays else ids.SAMPLE_TABLES
        for ob in (self.surface, *self.followers, *_tables_of(self.followers)):
            if mending.is_broken(ob):
                yield Trouble(f"A node group that {ob.name} needs was deleted", remedy)
        for ob in self.strays:
            text = (
                f"{ob.name} has lost the modifier by which it followed: the modifier was deleted "
                "or applied, or its node group was deleted. If it was applied, first go to the "
                "frame in which that was done"
            )
            yield Trouble(text, ids.FOLLOW)
        for ob in self.followers:
            table = groups.get_input(modifier_of(ob), TILES)
            of = tables.surface_of(table) if table else None
            if table is None or tables.points_of(table) is None:
                yield Trouble(f"The hidden tables that {ob.name} reads were deleted", ids.FOLLOW)
            elif of != self.surface:
                whose = of.name if of else "a surface that was deleted"
                text = f"{ob.name} follows {self.surface.name}, but reads the tables of {whose}"
                yield Trouble(text, ids.FOLLOW)
        is_read = self.followers or self.strays or self.samples or self.children
        if is_read and (text := capture_place.obstacle(self.surface)):
            yield Trouble(text, remedy)
        if self.samples is not None:
            if mending.is_broken(self.samples):
                text = f"A node group that {self.samples.name} needs was deleted"
                yield Trouble(text, ids.SAMPLE_TABLES)
            if tables.points_of(self.samples) is None:
                text = f"The hidden table of points that {self.samples.name} reads was deleted"
                yield Trouble(text, ids.SAMPLE_TABLES)

    def _misled(self, signature: str | None) -> Iterator[Trouble]:
        for ob in self.astray:
            # Follow finds the places of control points anew
            holder = holder_of(ob) if ob.type != "CURVE" else None
            is_other = signature and holder and not following.holds(holder, signature)
            yield Trouble(why_astray(ob), ids.REBIND if is_other else ids.FOLLOW)

    def _left_behind(self) -> Iterator[Trouble]:
        for table in _tables_of(self.followers):
            is_its = tables.surface_of(table) == self.surface and tables.is_own(table)
            if is_its and (text := proxy.trouble(self.surface, table)):
                yield Trouble(text, ids.FOLLOW)

    def _added(self) -> Iterator[Trouble]:
        for ob in self.followers:
            holder = holder_of(ob)
            count = seals.count_broken(holder) if holder else 0
            if count:
                were = by_count(count, "was", "were")
                text = f"{counted(count, 'vertices')} of {ob.name} {were} added since it was bound"
                yield Trouble(text, ids.FOLLOW)

    def _changed_faces(self, signature: str) -> Iterator[Trouble]:
        name = self.surface.name
        for ob in self.followers:
            holder = holder_of(ob)
            if holder is not None and not following.holds(holder, signature):
                text = f"The faces of {name} have changed since {ob.name} was bound"
                yield Trouble(text, ids.REBIND)

    def _changed_rules(self, signature: str) -> Iterator[Trouble]:
        table = tables.of_surface(self.surface)
        if table is not None and table.get(ids.SIGNATURE) != signature:
            text = (
                f"The creases or subdivision settings of {self.surface.name} have changed since "
                "its tables were made"
            )
            if tables.points_of(table) is not None and not tables.fits(table):
                text += (
                    f". What follows {self.surface.name} by nodes is at rest until you run Rebind "
                    "to Limit Surface. If the creases are animated, use the mode Live"
                )
            yield Trouble(text, ids.REBIND)

    def stale_samples(self, signature: str) -> Iterator[Trouble]:
        """Yields what is wrong if the table of all tiles was made for another surface."""
        if self.samples is not None and self.samples.get(ids.SIGNATURE) != signature:
            text = (
                f"The faces, creases or subdivision settings of {self.surface.name} have changed "
                f"since its tables for {ids.SAMPLE_GROUP} were made"
            )
            yield Trouble(text, ids.SAMPLE_TABLES)


def surfaces() -> list[bpy.types.Object]:
    """Returns all surfaces that the file's own objects follow, or have followed, and those that the
    file's own tables of all tiles belong to.
    """
    found: dict[bpy.types.Object, None] = {}
    for ob in bpy.data.objects:
        if ob.library is not None:
            continue
        surface = tables.surface_of(ob) if ids.ALL_TILES_MARK in ob else None
        state = State.of(ob) if was_bound(ob) or live_children.modifier_of(ob) else None
        for each in (surface, state.surface if state else None):
            if each is not None:
                found[each] = None
    return list(found)


def _after_changes(remedy: str) -> str:
    return ids.REBIND if remedy == ids.FOLLOW else remedy


def _tables_of(followers: list[bpy.types.Object]) -> list[bpy.types.Object]:
    read = dict.fromkeys(groups.get_input(modifier_of(ob), TILES) for ob in followers)
    return [table for table in read if table is not None]
