# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends following: things stay where they are shown now, or go back to where they were at rest."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Literal

import bpy
import numpy as np

from .. import ids, native
from ..counting import by_count, counted
from ..errors import CageError, NotNowError, RefusalError
from ..nodes import groups
from ..nodes.follow import SURFACE, TILES
from ..reading import attributes, cage, rigid_bodies, transform
from ..tasks.job import Progress
from ..tasks.piecewise_job import Pieces, aside, at_once
from . import capture_place, followers, following, proxy, seals, tables
from .applied_shapes import rows_as_posed
from .places import NOWHERE, Places
from .posed_surface import PosedSurface
from .relocation import Elements

Shape = Literal["SHOWN", "REST"]

# What the modifiers of following change
_MOVED = (
    *(ids.POSITION, ids.HANDLE_LEFT, ids.HANDLE_RIGHT),
    *(ids.NORMAL, ids.TANGENT, ids.ROTATION, ids.CUSTOM_NORMAL),
)


@dataclass
class _Frozen:
    """New values of attributes of one data-block."""

    data: bpy.types.ID
    values: dict[str, np.ndarray] = field(default_factory=dict)

    def write(self) -> None:
        for name, values in self.values.items():
            attribute = self.data.attributes[name]
            attributes.write(self.data, name, attribute.data_type, attribute.domain, values)
        if isinstance(self.data, bpy.types.Mesh):
            self.data.update()  # its normals, which depend on the positions
        self.data.update_tag()


class Unbinding:
    """What is written when some followers are unbound, in three steps: they are checked, their
    shapes are computed, and they are written. Raises RefusalError for those that cannot be unbound;
    nothing has changed then.
    """

    def __init__(self, things: Sequence[bpy.types.Object], shape: Shape) -> None:
        for ob in things:
            following.check_editable(ob)
        self._things, self._shape = list(things), shape
        self._frozen: list[_Frozen] = []
        if shape == "SHOWN":
            for ob in things:
                followers.check_not_astray(ob)
                _check_own_data(ob)

    def compute(self, context: bpy.types.Context) -> Pieces:
        """Finds the shapes in which things are left. Blender evaluates one thing after the other,
        and cannot be cancelled within one.
        """
        if self._shape != "SHOWN":
            return
        posed: dict[bpy.types.Object | None, PosedSurface | None] = {}
        for i, ob in enumerate(self._things):
            yield i / len(self._things)
            depsgraph = context.evaluated_depsgraph_get()
            surface = followers.surface_of(ob)
            if surface not in posed:
                posed[surface] = posed_if_there(surface, depsgraph)
            self._frozen.append((yield from _freeze(ob, posed[surface], depsgraph)))

    def write(self, _depsgraph: bpy.types.Depsgraph | None = None) -> str:
        """Changes the file, and returns a report."""
        surfaces, used = set(), set()
        for ob in self._things:
            modifier = followers.modifier_of(ob)
            if modifier is None:  # it was deleted or applied before
                surface = followers.surface_of(ob)
                surfaces.add(surface)
                used.add(tables.of_surface(surface) if surface else None)
                continue
            surfaces.add(groups.get_input(modifier, SURFACE))
            used.add(groups.get_input(modifier, TILES))
            own_table = followers.curve_table(ob)
            ob.modifiers.remove(modifier)
            if own_table and not tables.readers(own_table):
                tables.remove_object(own_table)
        for frozen in self._frozen:
            frozen.write()
        for data in followers.holders(self._things):
            if not any(followers.modifier_of(other) for other in followers.users_of(data)):
                _remove_attributes(data)
        _remove_unused(used - {None}, surfaces - {None})
        names = ", ".join(ob.name for ob in self._things)
        remove_unused_carriers()
        shape = "of this frame" if self._frozen else "at rest"
        return f"Unbound in the shape {shape}: {names}"


def _check_own_data(ob: bpy.types.Object) -> None:
    if ob.type == "CURVE":
        raise RefusalError(
            f"{ob.name} is a Curve object, which cannot store the shape that nodes give it in this "
            "frame: choose the shape At Rest, or convert it to hair curves first (Object > Convert "
            "> Curves)"
        )
    others = [other.name for other in followers.sharers(ob)]
    if others:
        raise RefusalError(
            f"{ob.name} shares its data with {others[0]}: make it a single user, or choose the "
            "shape At Rest"
        )
    if getattr(ob.data, "shape_keys", None):
        raise RefusalError(
            f"{ob.name} has shape keys: apply them first, or choose the shape At Rest"
        )


def posed_if_there(
    surface: bpy.types.Object | None, depsgraph: bpy.types.Depsgraph
) -> PosedSurface | None:
    """Returns the surface as it is now; None where there is none any more. Raises NotNowError for
    one that is there and cannot be read now.
    """
    try:
        return PosedSurface(cage.read(surface, depsgraph)) if surface else None
    except NotNowError:
        raise
    except CageError:
        return None


def shown_now(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> dict[str, np.ndarray]:
    """Returns the attributes of what follows by nodes as they would be if it was unbound as shown.
    Raises RefusalError where that is impossible.
    """
    posed = posed_if_there(followers.surface_of(ob), depsgraph)
    frozen: _Frozen = at_once(_freeze(ob, posed, depsgraph))
    return frozen.values


def _freeze(
    ob: bpy.types.Object, posed: PosedSurface | None, depsgraph: bpy.types.Depsgraph
) -> Pieces:
    """Returns what the modifier shows (_Frozen). The places at rest are those of this frame then,
    so that what is bound again does not move.
    """
    data, frozen = ob.data, _Frozen(ob.data)
    was_applied = followers.is_stray(ob)
    frozen.values = {} if was_applied else _shown(ob, depsgraph)
    yield 0.0
    if any(len(attributes.read(data, name)) != len(v) for name, v in frozen.values.items()):
        raise RefusalError(
            f"The modifier by which {ob.name} follows gives it another number of points: run "
            "Unbind from Limit Surface with the shape At Rest"
        )
    if not was_applied and all(
        np.array_equal(attributes.read(data, name), v) for name, v in frozen.values.items()
    ):
        return frozen  # it is at rest, because its tables do not fit
    if not (followers.is_placed(ob) and ids.TILE in data.attributes):
        return frozen  # somebody has removed or changed its places
    follows = attributes.read(data, ids.TILE) > 0
    if count := seals.count_broken(data):
        were = by_count(count, "was", "were")
        raise RefusalError(
            f"{counted(count, 'vertices')} of {ob.name} {were} added since it was bound: run "
            "Follow Limit Surface first, or Unbind from Limit Surface with the shape At Rest"
        )
    if posed is None or not following.holds(data, following.signature(posed.cage)):
        face = attributes.read(data, ids.FACE)
        face[follows] = NOWHERE
        frozen.values[ids.FACE] = face
        return frozen
    Places.read(data).check(posed.in_object.face_count, posed.cage.name)
    if was_applied:
        rows = yield from rows_as_posed(Elements(ob), posed)
        if not len(rows):
            return frozen  # its modifier was deleted, or applied where the surface was at rest
    face, uv = (attributes.read(data, name)[follows] for name in (ids.FACE, ids.UV))
    matrix = transform.world_matrix(ob)

    def place(_progress: Progress) -> tuple[np.ndarray, np.ndarray]:
        places = posed.places(face, uv.astype(np.float64), matrix)
        return places.position, native.limitsurf.quaternions(places.frame)

    root, rotation = yield from aside(place)
    for name, values in ((ids.REST_ROOT, root), (ids.REST_ROTATION, rotation)):
        frozen.values[name] = attributes.read(data, name)
        frozen.values[name][follows] = values
    return frozen


def _shown(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> dict[str, np.ndarray]:
    """Returns what the modifier of following alone makes of the object."""
    modifier = followers.modifier_of(ob)
    assert modifier is not None
    evaluated = ob.evaluated_get(depsgraph)
    is_alone = [m for m in ob.modifiers if m.show_viewport] == [modifier]
    is_seen = is_alone and evaluated.is_evaluated and not proxy.is_read_by(ob)
    if is_seen and rigid_bodies.are_simulated(depsgraph.scene):
        return _moved_values(ob, evaluated)

    def leave_alone(copy: bpy.types.Object, _scene: bpy.types.Scene) -> None:
        for other in list(copy.modifiers):
            if other.name != modifier.name:
                copy.modifiers.remove(other)

    with (
        proxy.aside(),
        cage.evaluated_copy(ob, len(ob.modifiers), depsgraph, leave_alone) as evaluated,
    ):
        return _moved_values(ob, evaluated)


def _moved_values(ob: bpy.types.Object, evaluated: bpy.types.Object) -> dict[str, np.ndarray]:
    stored = ob.data.attributes
    # Normals that are angles turn with the polygons.
    names = [n for n in _MOVED if n in stored and stored[n].data_type in attributes.LAYOUTS]
    return {name: attributes.read(evaluated.data, name) for name in names}


def _remove_attributes(data: bpy.types.ID) -> None:
    for name in (ids.TILE, ids.TILE_UV):
        attribute = data.attributes.get(name)
        if attribute:
            data.attributes.remove(attribute)
    if ids.SIGNATURE in data:
        del data[ids.SIGNATURE]
    data.update_tag()


def remove_unused_carriers() -> None:
    """Removes carriers of attached objects that neither follow a surface nor carry anything any
    more: they have been unbound, and what they carried was deleted, detached or attached again.
    """
    for ob in list(bpy.data.objects):
        is_carrier = ob.library is None and not ob.override_library and ids.CARRIER_MARK in ob
        follows = followers.modifier_of(ob) or followers.live_modifier_of(ob)
        if is_carrier and not follows and not ob.children:
            tables.remove_object(ob)


def leftovers_of(surface: bpy.types.Object) -> list[bpy.types.Object]:
    """Returns the tables of a surface that nothing reads: what followed it has been deleted. Those
    of all tiles are not among them, because users have made these on their own. Unread tables of
    live children and Curve objects, which belong to no surface, are among them.
    """
    of_tiles = [
        table
        for table in tables.all_of_surface(surface)
        if ids.ALL_TILES_MARK not in table and not tables.readers(table)
    ]
    return [*of_tiles, *tables.unread()]


def remove_leftovers(surface: bpy.types.Object) -> str:
    """Removes those tables, and *Limit Capture* if nothing follows the surface. Returns a sentence
    for the report.
    """
    leftovers = leftovers_of(surface)
    had_capture = any(groups.modifiers(surface, ids.CAPTURE_GROUP))
    had_applied = capture_place.holds_applied(surface)
    count, of_tiles = len(leftovers), [ob for ob in leftovers if tables.surface_of(ob)]
    _remove_unused(of_tiles, {surface})
    has_capture = any(groups.modifiers(surface, ids.CAPTURE_GROUP))
    removed = [counted(count, "hidden tables")] if count else []
    if had_capture and not has_capture:
        removed.append(f"the modifier {ids.CAPTURE_GROUP}")
    if had_applied and not capture_place.holds_applied(surface):
        removed.append(
            f"the attributes that the applied modifier {ids.CAPTURE_GROUP} left in the mesh"
        )
    return f"Nothing follows {surface.name}. Removed: {', '.join(removed)}"


def _remove_unused(used: Iterable[bpy.types.Object], surfaces: set[bpy.types.Object]) -> None:
    """Removes tables that nothing reads any more, and *Limit Capture* from surfaces that no tables
    read any more.
    """
    for table in used:
        if tables.is_own(table) and not tables.readers(table):
            surfaces.add(tables.surface_of(table))
            proxy.update(None, table, False)
            tables.remove(table)
    tables.remove_unread()
    for surface in surfaces - {None}:
        following.remove_unused_capture(surface)
