# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of hair in this frame, with the places at rest that go with it.

The data of hair that follows by nodes hold its shape at rest, and the data of hair that follows
live hold its places at rest. What is moved where it is seen needs both as they are now.
"""

from __future__ import annotations

import bpy
import numpy as np

from .. import ids, native
from ..reading import attributes, cage
from ..tasks.object_keys import ObjectKey
from . import live_attributes
from .followers import check_not_astray, live_modifier_of, modifier_of, surface_of
from .live_unbinding import places_now
from .posed_surface import PosedSurface
from .unbinding import shown_now


class PresentShape:
    """Raises RefusalError or CageError where it is not known."""

    def __init__(self, ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
        check_not_astray(ob)
        self._key = ObjectKey.of(ob)  # undo may take all data away while hair is dragged
        self._values: dict[str, np.ndarray] = {}  # of those attributes that differ from the data's
        surface = surface_of(ob)
        if modifier_of(ob):
            self._values = shown_now(ob, depsgraph)
        elif live_modifier_of(ob) and surface is not None and not live_attributes.missing(ob.data):
            posed = PosedSurface(cage.read(surface, depsgraph))
            rows, places = places_now(ob, surface, posed)
            rotation = attributes.read(ob.data, ids.REST_ROTATION)
            rotation[rows] = native.limitsurf.quaternions(places.frame)
            self._values[ids.REST_ROTATION] = rotation

    @property
    def data(self) -> bpy.types.Curves:
        return self._key.find().data

    def read(self, name: str) -> np.ndarray:
        """Returns a copy of the attribute's values."""
        if name in self._values:
            return self._values[name].copy()
        return attributes.read(self.data, name)
