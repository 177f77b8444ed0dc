# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends live following: things stay where they are now, or go back to where they were at rest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import bpy
import numpy as np

from .. import ids, native
from ..reading import attributes, cage, transform
from . import followers, following, live, live_attributes, live_binding
from .places import Places
from .posed_surface import Places as PosedPlaces
from .posed_surface import PosedSurface


class LiveUnbinding:
    """What is written when some things cease to follow live. Raises RefusalError for those that
    cannot; nothing has changed then.
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
        self._things, self._shape = list(things), shape
        self._surfaces = {ob: live.surface_of(ob) for ob in things}
        self._posed = {
            surface: PosedSurface(cage.read(surface, depsgraph))
            for surface in set(self._surfaces.values()) - {None}
        }
        self._now = {
            ob: places_now(ob, surface, self._posed[surface])
            for ob, surface in self._surfaces.items()
            if shape == "SHOWN" and surface is not None and not live_attributes.missing(ob.data)
        }

    def write(self, depsgraph: bpy.types.Depsgraph) -> str:
        """Changes the file, and returns a report."""
        for ob in self._surfaces:
            if ob not in self._now:
                live_binding.end(ob, depsgraph)
                continue
            _bind_here(ob, *self._now[ob])
            live_attributes.leave(ob.data)
            modifier = followers.live_modifier_of(ob)
            if modifier is not None:
                ob.modifiers.remove(modifier)
        for surface in self._posed:
            following.remove_unused_capture(surface)
        names = ", ".join(ob.name for ob in self._things)
        where = "where they are shown now" if self._shape == "SHOWN" else "where they are at rest"
        return f"Unbound {where}: {names}"


def places_now(
    ob: bpy.types.Object, surface: bpy.types.Object, posed: PosedSurface
) -> tuple[np.ndarray, PosedPlaces]:
    """Returns the rows of the elements that follow, and their places in this frame."""
    stored = Places.read(ob.data)
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
