# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends live following: things stay where they are now, or go back to where they were at rest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import bpy
import numpy as np

from .. import ids, native
from ..reading import attributes, cage
from . import followers, following, live, live_binding, live_thing
from .places import Places
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

    def write(self, depsgraph: bpy.types.Depsgraph) -> str:
        """Changes the file, and returns a report."""
        for ob, surface in self._surfaces.items():
            if self._shape == "REST" or surface is None or live_thing.missing(ob.data):
                live_binding.end(ob, depsgraph)
                continue
            self._bind_here(ob, self._posed[surface])
            live_thing.leave(ob.data)
            modifier = followers.live_modifier_of(ob)
            if modifier is not None:
                ob.modifiers.remove(modifier)
        for surface in self._posed:
            following.remove_unused_capture(surface)
        names = ", ".join(ob.name for ob in self._things)
        where = "where they are shown now" if self._shape == "SHOWN" else "where they are at rest"
        return f"Unbound {where}: {names}"

    def _bind_here(self, ob: bpy.types.Object, posed: PosedSurface) -> None:
        """Makes the places of this frame those at rest, so that what is bound again does not
        move.
        """
        data, stored = ob.data, Places.read(ob.data)
        places = posed.places(stored.face, stored.uv, np.array(ob.matrix_world, np.float64))
        for name, kind, values in (
            (ids.REST_ROOT, "FLOAT_VECTOR", places.position),
            (ids.REST_ROTATION, "QUATERNION", native.limitsurf.quaternions(places.frame)),
        ):
            new = attributes.read(data, name)
            new[stored.rows] = values
            attributes.write(data, name, kind, followers.domain_of(ob), new)
