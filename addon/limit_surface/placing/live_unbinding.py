# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends live following: things stay where they are now, or go back to where they were at rest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import bpy
import numpy as np

from .. import ids, native
from ..reading import attributes, cage, transform
from . import followers, following, live, live_attributes, live_binding, live_source
from .places import NOWHERE, Places
from .posed_surface import Places as PosedPlaces
from .posed_surface import PosedSurface
from .unbinding import posed_if_there, remove_unused_carriers

_NO_ROWS = np.empty(0, np.int64)


class LiveUnbinding:
    """What is written when some things cease to follow live. Raises RefusalError for those that
    cannot; nothing has changed then. Elements that are left as they are shown, and whose surface or
    faces are not there any more, lose their places.
    """

    def __init__(
        self,
        things: Sequence[bpy.types.Object],
        depsgraph: bpy.types.Depsgraph,
        shape: Literal["SHOWN", "REST"],
    ) -> None:
        things = live_binding.with_sharers(things)
        for ob in things:
            following.check_editable(ob)
            if shape == "SHOWN":
                followers.check_not_astray(ob)
        self._things, self._shape = list(things), shape
        self._surfaces = {ob: live.surface_of(ob) for ob in things}
        for surface in set(self._surfaces.values()) - {None}:
            cage.check_not_edited(surface)  # edits of what follows it could not be taken up
        self._now: dict[bpy.types.Object, _Now] = {}
        if shape == "SHOWN":
            posed = {s: posed_if_there(s, depsgraph) for s in set(self._surfaces.values())}
            self._now = {
                ob: _Now(ob, surface, posed[surface])
                for ob, surface in self._surfaces.items()
                if not live_attributes.missing(ob.data)
            }

    def write(self, depsgraph: bpy.types.Depsgraph) -> str:
        """Changes the file, and returns a report."""
        for ob in self._surfaces:
            if ob not in self._now:
                live_binding.end(ob, depsgraph)
                continue
            self._now[ob].write()
            live_attributes.leave(ob.data)
            modifier = followers.live_modifier_of(ob)
            if modifier is not None:
                ob.modifiers.remove(modifier)
        for surface in set(self._surfaces.values()) - {None}:
            following.remove_unused_capture(surface)
        names = ", ".join(ob.name for ob in self._things)
        remove_unused_carriers()
        shape = "of this frame" if self._shape == "SHOWN" else "at rest"
        return f"Unbound in the shape {shape}: {names}"


class _Now:
    """The places in this frame of what one object has on its surface; without places, the elements
    that lose them.
    """

    def __init__(
        self, ob: bpy.types.Object, surface: bpy.types.Object | None, posed: PosedSurface | None
    ) -> None:
        self._ob = ob
        stored = Places.read(ob.data)
        follows = stored.rows[~live_attributes.added(ob.data)[stored.rows]]
        self._lost, self._kept = follows, _NO_ROWS
        if surface is None or posed is None or _is_stale(ob, surface, posed):
            return
        # modifiers of the surface may have removed faces in this frame
        is_lost = attributes.read(ob.data, ids.FACE)[follows] >= posed.in_object.face_count
        self._lost = follows[is_lost]
        self._kept, self._places = places_now(ob, surface, posed, without=self._lost)

    def write(self) -> None:
        if len(self._kept):
            _bind_here(self._ob, self._kept, self._places)
        if len(self._lost):
            face = attributes.read(self._ob.data, ids.FACE)
            face[self._lost] = NOWHERE
            attributes.write(self._ob.data, ids.FACE, "INT", followers.domain_of(self._ob), face)
            if not len(self._kept):
                self._ob.data.pop(ids.SIGNATURE, None)


def _is_stale(ob: bpy.types.Object, surface: bpy.types.Object, posed: PosedSurface) -> bool:
    source, signature = live_source.source_of(surface), following.signature(posed.cage)
    try:
        live_source.check(ob, surface, source, signature)
    except live_source.StaleFacesError:
        return True
    return False


def places_now(
    ob: bpy.types.Object,
    surface: bpy.types.Object,
    posed: PosedSurface,
    without: np.ndarray = _NO_ROWS,
) -> tuple[np.ndarray, PosedPlaces]:
    """Returns the rows of the elements that follow, and their places in this frame. Elements may be
    left out.
    """
    stored = Places.read(ob.data).without(without)
    stored.check(posed.in_object.face_count, surface.name)
    follows = ~live_attributes.added(ob.data)[stored.rows]
    places = posed.places(stored.face[follows], stored.uv[follows], transform.world_matrix(ob))
    return stored.rows[follows], places


def _bind_here(ob: bpy.types.Object, rows: np.ndarray, places: PosedPlaces) -> None:
    """Makes the places of this frame those at rest, so that what is bound again does not move."""
    for name, kind, values in (
        (ids.REST_ROOT, "FLOAT_VECTOR", places.position),
        (ids.REST_ROTATION, "QUATERNION", native.limitsurf.quaternions(places.frame)),
    ):
        new = attributes.read(ob.data, name)
        new[rows] = values
        attributes.write(ob.data, name, kind, followers.domain_of(ob), new)
