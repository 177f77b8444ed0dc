# SPDX-License-Identifier: GPL-3.0-or-later
"""Has things follow a surface live, or ends that. Nothing moves by it."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial

import bpy

from .. import ids, native
from ..errors import RefusalError
from ..nodes import groups
from ..nodes.follow import SURFACE
from ..nodes.live import FOLLOW_LIVE
from ..reading import cage
from ..tasks.piecewise_job import Pieces, at_once
from . import (
    followers,
    following,
    live,
    live_attributes,
    live_source,
    live_surface,
    live_thing,
    newcomers,
)
from .places import Places
from .relocation import Relocation
from .unbinding import Unbinding


@dataclass(frozen=True)
class LiveOutcome:
    surface: str
    followers: int  # the number of strands and points

    def __str__(self) -> str:
        return f"{following.counted(self.followers)} {self.surface} live"


class LiveRequest:
    """What makes things follow one surface live, in three steps: they are checked, located, and
    written. The first two raise RefusalError, MeshError or LocationError for those that cannot
    follow; nothing has changed then.
    """

    def __init__(
        self,
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        things: Sequence[bpy.types.Object],
    ) -> None:
        following.check_surface(surface, depsgraph.scene)
        things = with_sharers(things)
        for ob in things:
            following.check_thing(ob, surface)
            _check_kind(ob)
            live.check_sharers(ob, surface, depsgraph)
        self._surface, self._things = surface, list(things)
        self._relocations: list[Relocation] | None = None
        self._by_nodes = [ob for ob in things if followers.modifier_of(ob)]
        self._unbinding = Unbinding(self._by_nodes, "REST")

    def locate(self, depsgraph: bpy.types.Depsgraph) -> Pieces:
        """Finds the places of things that have none yet."""
        found = cage.read(self._surface, depsgraph)
        self._signature, limit = following.signature(found), found.surface()
        located = yield from newcomers.relocations(self._things, self._surface, depsgraph)
        relocated = {relocation.data for relocation in located}
        for ob in self._things:
            if ob.data not in relocated:
                following.check_holds(ob, self._surface, self._signature)
                Places.read(ob.data).check(limit.face_count, self._surface.name)
                with native.rows_called(partial(followers.element_called, ob)):
                    live_thing.check(ob.data, limit)
        self._relocations = located

    def write(self, context: bpy.types.Context) -> LiveOutcome:
        if self._relocations is None:
            at_once(self.locate(context.evaluated_depsgraph_get()))
        places = {
            ob: ob.modifiers.find(modifier.name)
            for ob in self._by_nodes
            if (modifier := followers.modifier_of(ob))
        }
        for ob in self._things:
            if followers.live_modifier_of(ob) and not live_attributes.missing(ob.data):
                live.take_up_edits(ob, context.evaluated_depsgraph_get())
            elif live_attributes.written(ob.data) is None:
                following.settle(ob)
        for relocation in self._relocations or ():
            relocation.write()
        for ob in self._things:
            modifier = followers.live_modifier_of(ob)
            if modifier is None:
                modifier = groups.add_modifier(ob, FOLLOW_LIVE, place=places.get(ob, 0))
            groups.set_input(modifier, SURFACE, self._surface)
        if self._by_nodes:
            # only now: a carrier that follows nothing and carries nothing would be removed
            self._unbinding.write()
        following.ensure_capture(self._surface)
        live.read_anew(self._surface)
        followers.note_surface(self._things, self._surface)
        for ob in self._things:
            live_source.store(ob.data, self._surface, self._signature)
        depsgraph = context.evaluated_depsgraph_get()
        for ob in self._things:
            if live_attributes.missing(ob.data):
                live.start(ob, self._surface, depsgraph)
            else:
                live.take_up_edits(ob, depsgraph)
                live.admit(ob, self._surface, depsgraph)
        live.pose_all(depsgraph)
        blocks = followers.holders(self._things)
        count = sum(len(data.attributes[ids.FACE].data) for data in blocks)
        return LiveOutcome(self._surface.name, count)


def have_follow(
    context: bpy.types.Context,
    surface: bpy.types.Object,
    ob: bpy.types.Object,
    bindings: following.Bindings | None,
    follow: str,
) -> str:
    """Has a new object follow its surface by nodes, if there are bindings for that, or live if that
    was chosen. Returns how it follows, for the report; nothing if it stays where it is.
    """
    if bindings:
        bindings.write(ob)
        return "by Geometry Nodes"
    if follow == "LIVE":
        LiveRequest(surface, context.evaluated_depsgraph_get(), [ob]).write(context)
        return "live"
    return ""


def _check_kind(ob: bpy.types.Object) -> None:
    if ob.type == "CURVE":
        raise RefusalError(
            f"{ob.name} is a Curve object, whose data cannot hold a shape at rest: let it follow "
            "by nodes, or convert it to hair curves (Object > Convert > Curves)"
        )
    stored = ob.data.attributes.get(ids.CUSTOM_NORMAL)
    if stored and stored.data_type == "FLOAT_VECTOR" and stored.domain != "CORNER":
        raise RefusalError(
            f"{ob.name} has custom normals that are not stored at the corners of its faces. Live "
            "following cannot turn these: let it follow by nodes"
        )
    if getattr(ob.data, "shape_keys", None):
        raise RefusalError(
            f"{ob.name} has shape keys. Live following cannot move these: let it follow by nodes, "
            "or apply the shape keys"
        )


def prepare_rebinding(things: Sequence[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> None:
    """Takes up edits of things that are about to get other places. Raises RefusalError for one that
    has lost its shape at rest.
    """
    for ob in things:
        lacking = live_attributes.missing(ob.data)
        if lacking:
            raise RefusalError(
                f"{ob.data.name} has no attribute {lacking}: run Follow Limit Surface again"
            )
    for ob in things:
        try:
            live.take_up_edits(ob, depsgraph)
        except live_surface.unfit:
            continue  # its faces are not there any more, so that it has not been posed since


def finish_rebinding(
    things: Sequence[bpy.types.Object],
    surface: bpy.types.Object,
    signature: str,
    context: bpy.types.Context,
) -> None:
    """Poses things that have got other places on a surface with this signature."""
    if not things:
        return
    following.ensure_capture(surface)
    live.read_anew(surface)
    followers.note_surface(things, surface)
    for ob in things:
        if modifier := followers.live_modifier_of(ob):  # it may name another surface
            groups.set_input(modifier, SURFACE, surface)
        live_source.store(ob.data, surface, signature)
    depsgraph = context.evaluated_depsgraph_get()
    for ob in things:
        live.admit(ob, surface, depsgraph)
    if live.is_enabled(depsgraph.scene):
        live.pose_all(depsgraph)


def with_sharers(things: Sequence[bpy.types.Object]) -> list[bpy.types.Object]:
    """Returns the things and the other users of their data: all of these follow live, or none."""
    found = dict.fromkeys(things)
    for ob in things:
        found.update(dict.fromkeys(followers.sharers(ob)))
    return list(found)


def with_live_sharers(things: Sequence[bpy.types.Object]) -> list[bpy.types.Object]:
    """Returns the things, and the other users of the data of those that follow live."""
    live_ones = [ob for ob in things if followers.live_modifier_of(ob)]
    return list(dict.fromkeys([*things, *with_sharers(live_ones)]))


def end(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
    """Ends that the object, and all others that share its data, follow live. Their points are then
    at rest. Edits that were made after the surface was lost, or has got other faces, are lost.
    """
    if followers.live_modifier_of(ob) is None:
        return
    if not live_attributes.missing(ob.data):
        with suppress(*live_surface.unfit):
            live.take_up_edits(ob, depsgraph)
        live_attributes.stop(ob.data)
    for user in with_sharers([ob]):
        modifier = followers.live_modifier_of(user)
        if modifier is not None:
            user.modifiers.remove(modifier)
