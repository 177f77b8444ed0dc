# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that follow their surface by Geometry Nodes: what is bound to it, and how.

Nothing moves when it is bound: a thing keeps its points at rest, and its modifier moves them from
there.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import ids
from ..counting import by_count
from ..errors import RefusalError
from ..nodes import groups
from ..nodes.capture import CAPTURE, crease_sum, topology_sum
from ..nodes.follow import SURFACE, TILES
from ..reading import attributes, cage, overrides, rules
from ..tasks.object_keys import ObjectKey
from . import capture_place, live_attributes, proxy, render_faces, shared_tables, tables
from .follow_properties import follows
from .followers import (
    ensure_modifier,
    followed_surface,
    followers_of,
    holder_of,
    holders,
    is_astray,
    is_own,
    is_placed,
    live_followers_of,
    live_modifier_of,
    modifier_of,
    note_surface,
    own_followers_of,
    sharers,
    surface_of,
    users_of,
)
from .places import Places
from .relocation import TYPES, Relocation
from .roots import Locations

if TYPE_CHECKING:
    import limitsurf


@dataclass(frozen=True)
class Outcome:
    """What follows a surface after something was bound to it, for reports."""

    surface: str
    followers: int  # the number of new elements that follow
    resting: int  # the number of those without a place on the surface, which stay where they are

    def __str__(self) -> str:
        if not self.followers and not self.resting:
            return f"What follows {self.surface} was bound again"
        text = f"{counted(self.followers)} {self.surface} by Geometry Nodes"
        if not self.resting:
            return text
        stay = by_count(
            self.resting,
            "has no place on the surface and stays where it is",
            "have no place on the surface and stay where they are",
        )
        return f"{text}; {self.resting:,} {stay}"


def counted(followers: int) -> str:
    """Returns the beginning of a sentence about so many strands and points."""
    follow = by_count(followers, "strand or point follows", "strands and points follow")
    return f"{followers:,} {follow}"


class Request:
    """The binding of things to one surface, in three steps: it is read from Blender, computed
    where Blender's data need not be touched, and written. All that follows the surface already is
    bound again with it, because the tables are made for all of it together. Linked data and library
    overrides keep the tables that they come with.

    `without` are things that are about to get other locations.

    With a proxy the viewport stays fast (see `proxy`); None keeps what there was.

    Raises RefusalError for a surface or a thing that cannot be bound; nothing has changed then.
    """

    def __init__(
        self,
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        things: Sequence[bpy.types.Object] = (),
        use_proxy: bool | None = None,
        relocated: Sequence[Relocation] = (),
        without: Sequence[bpy.types.Object] = (),
    ) -> None:
        check_surface(surface, depsgraph.scene)
        render_faces.check(surface, depsgraph)
        for ob in things:
            check_thing(ob, surface)
            if modifier_of(ob) is None:
                check_first(ob)
        followers = [ob for ob in own_followers_of(surface) if ob not in without]
        for ob in followers:
            check_thing(ob, surface)
        self._surface, self._use_proxy = ObjectKey.of(surface), use_proxy
        self._things = [ObjectKey.of(ob) for ob in things]
        self._old = len(holders(followers))
        everything = dict.fromkeys([*followers, *things])
        self._followers = [ObjectKey.of(ob) for ob in everything]
        self._relocated = list(relocated)
        moved = {relocation.data: relocation.places for relocation in relocated}
        for ob in everything:
            if holder_of(ob) not in moved and not is_placed(ob):
                raise RefusalError(
                    f"{ob.name} follows {surface.name}, but its places on the limit surface "
                    "were deleted: run Follow Limit Surface on it first"
                )
        self._places = [moved.get(data) or Places.read(data) for data in holders(everything)]
        with cage.opened(surface, depsgraph) as (found, mesh):
            self._bound = bound_to(found, mesh)
        for ob in everything:
            if holder_of(ob) not in moved:
                check_holds(ob, surface, self._bound.signature)
        self._limit = found.surface()
        for place in self._places:
            place.check(self._limit.face_count, surface.name)

    def compute(self, new: Locations | None = None) -> Bindings:
        """Finds the tiles, also of things that do not exist yet at the given locations."""
        places = list(self._places)
        if new is not None:
            places.append(Places.of(new))
        tiles = self._limit.tiles(
            np.concatenate([place.face for place in places]),
            np.concatenate([place.uv for place in places]),
        )
        return Bindings(self, places, tiles)

    def write(self, made: Bindings, new: bpy.types.Object | None) -> Outcome:
        surface = self._surface.find()
        followers = [key.find() for key in self._followers]
        if new is not None:
            followers.append(new)
        shared_tables.separate(followers)
        for relocation in self._relocated:
            relocation.elements.read_holder()
        data_blocks = holders(followers)
        moved = {relocation.data for relocation in self._relocated}
        for data, place in zip(data_blocks, made.places, strict=True):
            if data not in moved:
                place.check_count(data)
        for ob in followers:
            settle(ob)
        for relocation in self._relocated:
            relocation.write()
        ensure_capture(surface)
        table = tables.write(surface, made.tiles, self._bound)
        proxy.update(surface, table, self._use_proxy)
        begin = 0
        for data, place in zip(data_blocks, made.places, strict=True):
            rows = slice(begin, begin + len(place.face))
            place.write(data, made.tiles.tile[rows], made.tiles.tile_uv[rows])
            data[ids.SIGNATURE] = self._bound.signature
            begin = rows.stop
        for ob in followers:
            ensure_modifier(ob, surface, table)
        note_surface(followers, surface)
        tables.remove_unread()
        fresh = made.places[self._old :]
        return Outcome(
            surface.name,
            sum(len(place.face) for place in fresh),
            sum(place.resting for place in fresh),
        )


@dataclass(frozen=True)
class Bindings:
    """The tiles of all places."""

    request: Request
    places: list[Places]
    tiles: limitsurf.Tiles

    def write(self, new: bpy.types.Object | None = None) -> Outcome:
        """Changes the file; `new` is the object with the locations that `compute` was given."""
        return self.request.write(self, new)


def request_for(
    follow: str, surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph
) -> Request | None:
    """Returns the binding of new things by the value of the property `follow`, or None if they are
    not to follow.
    """
    return Request(surface, depsgraph) if follows(follow, surface) else None


def bound_to(found: cage.Cage, mesh: bpy.types.Mesh) -> tables.Bound:
    edges = attributes.read(mesh, ids.EDGE_VERTICES)
    return tables.Bound(
        len(mesh.vertices), topology_sum(edges), _crease_sums(found, mesh), signature(found)
    )


def _crease_sums(found: cage.Cage, mesh: bpy.types.Mesh) -> tuple[int, int] | None:
    """Returns checksums of the creases of edges and vertices. It is None where the surface does not
    depend on creases, or nodes could round them to other numbers than numpy does.
    """
    if not found.rules.use_creases or found.rules.scheme == "bilinear":
        return None
    sums = []
    for name, domain, count in (
        (ids.EDGE_CREASE, "EDGE", len(mesh.edges)),
        (ids.VERTEX_CREASE, "POINT", len(mesh.vertices)),
    ):
        stored = mesh.attributes.get(name)
        if stored and (stored.data_type, stored.domain) != ("FLOAT", domain):
            return None
        creases = attributes.read(mesh, name) if stored else np.zeros(count)
        if not np.isfinite(creases).all():
            return None
        sums.append(crease_sum(creases))
    return sums[0], sums[1]


def signature(found: cage.Cage) -> str:
    """Returns two words: one that differs where the faces differ, and one that differs where only
    the rules of subdivision do, creases among them.
    """
    mesh = found.mesh
    faces = hashlib.sha256(str(len(mesh.positions)).encode())
    rule_names = (mesh.boundary, mesh.creasing, mesh.triangles, mesh.scheme)
    used = hashlib.sha256(" ".join(rule_names).encode())
    for digest, parts in (
        (faces, (mesh.face_sizes, mesh.face_vertices)),
        (used, (*mesh.edge_sharpness, *mesh.vertex_sharpness)),
    ):
        for part in parts:
            digest.update(np.ascontiguousarray(part).tobytes())
    return f"{faces.hexdigest()} {used.hexdigest()}"


def holds(data: bpy.types.ID, now: str) -> bool:
    """Tells whether stored locations are still on the faces that they were bound to. `now` is the
    surface's signature. What was never bound has none, and is taken at its word.
    """
    bound = data.get(ids.SIGNATURE)
    return bound is None or have_same_faces(str(bound), now)


def have_same_faces(one: str, other: str) -> bool:
    """Tells whether two surfaces with these signatures have the same faces."""
    return one.partition(" ")[0] == other.partition(" ")[0]


def check_holds(ob: bpy.types.Object, surface: bpy.types.Object, now: str) -> None:
    holder = holder_of(ob)
    if holder is not None and not holds(holder, now):
        if is_astray(ob):
            raise RefusalError(
                f"{ob.name} was bound to other faces than those that {surface.name} has now: run "
                "Rebind to Limit Surface"
            )
        raise RefusalError(
            f"{ob.name} was bound before the faces of {surface.name} changed: run Rebind to Limit "
            "Surface, or first Unbind from Limit Surface"
        )


def settle(ob: bpy.types.Object) -> None:
    """Puts strands and points of an object that does not follow live back to rest where they
    followed live before they were joined to it.
    """
    is_live = any(live_modifier_of(user) for user in (ob, *sharers(ob)))
    if ob.type in TYPES and not is_live and not live_attributes.missing(ob.data):
        live_attributes.stop(ob.data)


def ensure_capture(surface: bpy.types.Object) -> None:
    """Puts the modifier *Limit Capture* directly before the subdivision. What one that was applied
    has left in the mesh is removed.
    """
    capture_place.remove_applied(surface)
    modifier = next(groups.modifiers(surface, ids.CAPTURE_GROUP), None)
    if modifier is None:
        modifier = groups.add_modifier(surface, CAPTURE)
    modifier.show_viewport = modifier.show_render = True
    here = surface.modifiers.find(modifier.name)
    there = rules.place_of_subsurf(surface)
    wanted = there - 1 if here < there else there
    if here != wanted:
        surface.modifiers.move(here, wanted)


def _check_capture(surface: bpy.types.Object) -> None:
    """Raises RefusalError for an override to which the library has given *Limit Capture* at a place
    from which it cannot be moved to the subdivision.
    """
    modifier = next(groups.modifiers(surface, ids.CAPTURE_GROUP), None)
    if modifier is None or not overrides.is_of_library(modifier):
        return
    here, there = surface.modifiers.find(modifier.name), rules.place_of_subsurf(surface)
    passed = surface.modifiers[here + 1 : there] if here < there else surface.modifiers[there:here]
    if any(overrides.is_of_library(other) for other in passed):
        raise RefusalError(
            f"{surface.name} is a library override, in which modifiers of the library cannot be "
            f"moved: in the file from which it comes, move its modifier {modifier.name} directly "
            "before the Subdivision Surface modifier"
        )


def unused_captures(surface: bpy.types.Object) -> list[bpy.types.NodesModifier]:
    """Returns the modifiers *Limit Capture* that can be removed from a surface because nothing
    follows it: all that did has been unbound or deleted, or it is a copy of another surface.
    """
    captures = [
        modifier
        for modifier in groups.modifiers(surface, ids.CAPTURE_GROUP)
        if not overrides.is_of_library(modifier)
    ]
    if not captures or not surface.is_editable or _is_read(surface):
        return []
    return captures


def has_unused_attributes(surface: bpy.types.Object) -> bool:
    """Tells whether the mesh of a surface has attributes that a *Limit Capture* that was applied
    has left, although nothing follows any object with this mesh.
    """
    if not capture_place.has_removable(surface):
        return False
    return not any(_is_read(user) for user in users_of(surface.data))


def _is_read(surface: bpy.types.Object) -> bool:
    """Tells whether something follows the surface, or tables read it."""
    return bool(
        tables.all_of_surface(surface)
        or followers_of(surface)  # library overrides have tables of their own
        or live_followers_of(surface)
    )


def remove_unused_capture(surface: bpy.types.Object) -> None:
    """Removes *Limit Capture*, and what one that was applied has left, from a surface that nothing
    follows any more.
    """
    for modifier in unused_captures(surface):
        surface.modifiers.remove(modifier)
    if has_unused_attributes(surface):
        capture_place.remove_applied(surface)


def check_surface(surface: bpy.types.Object, scene: bpy.types.Scene) -> None:
    if surface.type != "MESH":
        raise RefusalError(f"{surface.name} is not a mesh")
    if not surface.is_editable:
        raise RefusalError(
            f"{surface.name} is linked from another file: make a library override of it, to "
            "which the modifier that following needs can be added"
        )
    if surface.name not in scene.objects:
        raise RefusalError(f"{surface.name} is not in the scene {scene.name}")
    cage.check_not_edited(surface)
    ambiguous = rules.why_ambiguous(surface)
    if ambiguous:
        raise RefusalError(ambiguous)
    _check_capture(surface)


def check_thing(ob: bpy.types.Object, surface: bpy.types.Object) -> None:
    check_editable(ob)
    modifier = modifier_of(ob)
    if modifier is not None:
        groups.check_inputs(modifier, SURFACE, TILES)
    # a mesh that stores no locations may have any mesh as its parent
    theirs = surface_of(ob) if is_placed(ob) or ob.type == "CURVES" else None
    if theirs not in (None, surface):
        raise RefusalError(
            f"{ob.name} belongs to {theirs.name}, not to {surface.name}: {_way_to(ob, surface)}"
        )
    for other in sharers(ob):
        if surface_of(other) not in (None, surface):
            raise RefusalError(
                f"{ob.name} shares its data with {other.name}, which stands on another surface: "
                "make it a single-user copy first"
            )
    carrier: bpy.types.Object | None = surface
    while carrier:
        if carrier == ob:
            raise RefusalError(
                f"{ob.name} cannot follow itself or an object that is parented to it"
            )
        carrier = carrier.parent


def _way_to(ob: bpy.types.Object, surface: bpy.types.Object) -> str:
    """Returns how an object that belongs to another surface comes to belong to this one."""
    if ob.type == "CURVES":
        return (
            f"choose {surface.name} in Object Data > Surface and run Rebind to Limit Surface, or "
            "run Snap to Limit Surface"
        )
    unbound = "run Unbind from Limit Surface, " if followed_surface(ob) else ""
    return f"{unbound}make {surface.name} its parent, and run Rebind to Limit Surface"


def check_first(ob: bpy.types.Object) -> None:
    """Raises RefusalError for an object before whose first modifier no other can be put."""
    if ob.modifiers and ob.modifiers[0].type == "MULTIRES":
        raise RefusalError(
            f"{ob.name}: Multiresolution ({ob.modifiers[0].name}) must be the first modifier, "
            "which following needs to be: apply it first"
        )


def check_editable(ob: bpy.types.Object) -> None:
    """Raises RefusalError for an object that cannot be bound or unbound, or for which Blender does
    not save that.
    """
    if not ob.is_editable or not ob.data.is_editable:
        raise RefusalError(f"{ob.name} is linked from another file: make it local first")
    if not is_own(ob):
        raise RefusalError(
            f"{ob.name} is a library override, and Blender does not save what it is bound to: make "
            "it and its data local first, or do this in the file from which it comes"
        )
    cage.check_not_edited(ob)  # other types than meshes have no data of their own there
