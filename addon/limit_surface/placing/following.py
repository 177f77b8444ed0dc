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
from ..errors import RefusalError
from ..nodes import groups
from ..nodes.capture import CAPTURE, topology_sum
from ..nodes.follow import FOLLOW_HAIR, FOLLOW_ORIENTED, FOLLOW_POINTS, SURFACE, TILES
from ..reading import attributes, cage, rules
from ..tasks.object_keys import ObjectKey
from . import proxy, tables
from .roots import Locations

if TYPE_CHECKING:
    import limitsurf

_GROUPS = (ids.FOLLOW_HAIR_GROUP, ids.FOLLOW_POINTS_GROUP, ids.FOLLOW_ORIENTED_GROUP)
_ROOT_KINDS = {
    ids.FACE: "INT",
    ids.UV: "FLOAT2",
    ids.REST_ROOT: "FLOAT_VECTOR",
    ids.REST_ROTATION: "QUATERNION",
}


@dataclass(frozen=True)
class Outcome:
    """What follows a surface after something was bound to it, for reports."""

    surface: str
    followers: int  # the number of new elements that follow
    resting: int  # the number of those without a place on the surface, which stay where they are

    def __str__(self) -> str:
        text = f"{self.followers:,} places follow {self.surface} by nodes"
        return f"{text}, {self.resting:,} stay at rest" if self.resting else text


def domain_of(ob: bpy.types.Object) -> str:
    """Returns the domain on which the object's locations are stored."""
    return "CURVE" if ob.type == "CURVES" else "POINT"


def is_placed(ob: bpy.types.Object) -> bool:
    """Tells whether the object stores locations on a surface."""
    if ob.type not in ("CURVES", "MESH", "POINTCLOUD"):
        return False
    stored = ob.data.attributes
    return all(
        name in stored and (stored[name].data_type, stored[name].domain) == (kind, domain_of(ob))
        for name, kind in _ROOT_KINDS.items()
    )


def modifier_of(ob: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """Returns the modifier by which the object follows a surface, if it does."""
    return next((m for name in _GROUPS for m in groups.modifiers(ob, name)), None)


def surface_of(ob: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the surface on which the object's things stand: that which it follows, hair's own
    surface, or a parent that is a mesh.
    """
    modifier = modifier_of(ob)
    if modifier and groups.get_input(modifier, SURFACE):
        return groups.get_input(modifier, SURFACE)
    if ob.type == "CURVES" and ob.data.surface:
        return ob.data.surface
    return ob.parent if ob.parent and ob.parent.type == "MESH" else None


def followers_of(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the file's own objects that follow a surface by nodes."""
    found = []
    for ob in bpy.data.objects:
        modifier = modifier_of(ob) if ob.library is None else None
        if modifier and groups.get_input(modifier, SURFACE) == surface:
            found.append(ob)
    return found


class Request:
    """The binding of things to one surface, in three steps: it is read from Blender, computed
    where Blender's data need not be touched, and written. All that follows the surface already is
    bound again with it, because the tables are made for all of it together.

    With a proxy the viewport stays fast (see `proxy`); None keeps what there was.

    Raises RefusalError for a surface or a thing that cannot be bound; nothing has changed then.
    """

    def __init__(
        self,
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        things: Sequence[bpy.types.Object] = (),
        use_proxy: bool | None = None,
    ) -> None:
        check_surface(surface, depsgraph.scene)
        for ob in things:
            check_thing(ob, surface)
        followers = followers_of(surface)
        for ob in followers:
            check_thing(ob, surface)
        self._surface, self._use_proxy = ObjectKey.of(surface), use_proxy
        self._things = [ObjectKey.of(ob) for ob in things]
        self._old = len({ob.data for ob in followers})
        everything = dict.fromkeys([*followers, *things])
        self._followers = [ObjectKey.of(ob) for ob in everything]
        self._places = [Places.read(data) for data in dict.fromkeys(ob.data for ob in everything)]
        with cage.opened(surface, depsgraph) as (found, mesh):
            edges = attributes.read(mesh, ids.EDGE_VERTICES)
            self._bound = tables.Bound(len(mesh.vertices), topology_sum(edges), signature(found))
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
        data_blocks = list(dict.fromkeys(ob.data for ob in followers))
        if new is not None:
            followers.append(new)
            data_blocks.append(new.data)
        for data, place in zip(data_blocks, made.places, strict=True):
            place.check_count(data)
        ensure_capture(surface)
        table = tables.write(surface, made.tiles, self._bound)
        proxy.update(surface, table, self._use_proxy)
        begin = 0
        for data, place in zip(data_blocks, made.places, strict=True):
            rows = slice(begin, begin + len(place.face))
            place.write(data, made.tiles.tile[rows], made.tiles.tile_uv[rows])
            begin = rows.stop
        for ob in followers:
            _ensure_modifier(ob, surface, table)
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


def unbind(ob: bpy.types.Object) -> None:
    """Removes what makes the object follow. Its points are then at rest."""
    modifier = modifier_of(ob)
    if modifier:
        ob.modifiers.remove(modifier)
    for name in (ids.TILE, ids.TILE_UV):
        attribute = ob.data.attributes.get(name)
        if attribute:
            ob.data.attributes.remove(attribute)


def signature(found: cage.Cage) -> str:
    """Returns a text that differs where the topology or the rules of subdivision differ."""
    mesh = found.mesh
    parts = [mesh.face_sizes, mesh.face_vertices, *mesh.edge_sharpness, *mesh.vertex_sharpness]
    rule_names = (mesh.boundary, mesh.creasing, mesh.triangles, mesh.scheme)
    digest = hashlib.sha256(" ".join(rule_names).encode())
    for part in parts:
        digest.update(np.ascontiguousarray(part).tobytes())
    return digest.hexdigest()


def ensure_capture(surface: bpy.types.Object) -> None:
    """Puts the modifier *Limit Capture* directly before the subdivision."""
    subsurf = rules.find_subsurf(surface)
    modifier = next(groups.modifiers(surface, ids.CAPTURE_GROUP), None)
    if modifier is None:
        modifier = groups.add_modifier(surface, CAPTURE)
    here = surface.modifiers.find(modifier.name)
    there = surface.modifiers.find(subsurf.name) if subsurf else len(surface.modifiers)
    wanted = there - 1 if here < there else there
    if here != wanted:
        surface.modifiers.move(here, wanted)


def check_surface(surface: bpy.types.Object, scene: bpy.types.Scene) -> None:
    if surface.type != "MESH":
        raise RefusalError(f"{surface.name} is not a mesh")
    if not surface.is_editable:
        raise RefusalError(
            f"{surface.name} is linked from another file: make a library override of it, which can "
            "have the modifier that hands on its control mesh"
        )
    if surface.name not in scene.objects:
        raise RefusalError(f"{surface.name} is not in the scene {scene.name}")
    if surface.mode == "EDIT":
        raise RefusalError(f"{surface.name} is in Edit Mode: leave it first")


def check_thing(ob: bpy.types.Object, surface: bpy.types.Object) -> None:
    if not is_placed(ob):
        raise RefusalError(f"{ob.name} stores no locations on a limit surface")
    if not ob.is_editable or not ob.data.is_editable:
        raise RefusalError(f"{ob.name} is linked from another file: make it local first")
    theirs = surface_of(ob)
    if theirs not in (None, surface):
        raise RefusalError(f"{ob.name} belongs to {theirs.name}, not to {surface.name}")
    if ob == surface:
        raise RefusalError(f"{ob.name} cannot follow itself")


@dataclass(frozen=True)
class Places:
    """The locations that some data stores, without those of elements that have none: curves that
    were added later have no rotation at rest, and snapped hair that is bound nowhere has the face
    -1.
    """

    count: int
    rows: np.ndarray  # (n,) the elements that have a location
    face: np.ndarray  # (n,)
    uv: np.ndarray  # (n, 2)

    @classmethod
    def read(cls, data: bpy.types.ID) -> Places:
        face = attributes.read(data, ids.FACE)
        turned = attributes.read(data, ids.REST_ROTATION).any(axis=1)
        rows = np.flatnonzero((face >= 0) & turned)
        uv = attributes.read(data, ids.UV)[rows].astype(np.float64)
        return cls(len(face), rows, face[rows], uv)

    @classmethod
    def of(cls, new: Locations) -> Places:
        rows = np.arange(len(new))
        return cls(len(new), rows, new.face, new.uv.astype(np.float64))

    @property
    def resting(self) -> int:
        return self.count - len(self.rows)

    def check(self, faces: int, surface: str) -> None:
        """Raises RefusalError where a face does not exist."""
        wrong = self.face[self.face >= faces]
        if len(wrong):
            raise RefusalError(
                f"A location is on face {wrong[0]}, but {surface} has {faces} faces: its topology "
                "has changed since things were placed on it"
            )

    def check_count(self, data: bpy.types.ID) -> None:
        stored = len(data.attributes[ids.FACE].data)
        if stored != self.count:
            raise RefusalError(
                f"{data.name} has changed meanwhile: it has {stored} elements instead of "
                f"{self.count}"
            )

    def write(self, data: bpy.types.ID, tile: np.ndarray, tile_uv: np.ndarray) -> None:
        numbers, place = np.zeros(self.count, np.int32), np.zeros((self.count, 2))
        numbers[self.rows], place[self.rows] = tile + 1, tile_uv
        domain = data.attributes[ids.FACE].domain
        attributes.write(data, ids.TILE, "INT", domain, numbers)
        attributes.write(data, ids.TILE_UV, "FLOAT2", domain, place)
        data.update_tag()


def _ensure_modifier(
    ob: bpy.types.Object, surface: bpy.types.Object, table: bpy.types.Object
) -> None:
    modifier = modifier_of(ob)
    if modifier is None:
        kind = FOLLOW_HAIR if ob.type == "CURVES" else FOLLOW_POINTS
        if ids.ROTATION in ob.data.attributes:
            kind = FOLLOW_ORIENTED
        # Other modifiers shape what follows, or put instances on it.
        modifier = groups.add_modifier(ob, kind, place=0)
    groups.set_input(modifier, SURFACE, surface)
    groups.set_input(modifier, TILES, table)
