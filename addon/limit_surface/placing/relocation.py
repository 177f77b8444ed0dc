# SPDX-License-Identifier: GPL-3.0-or-later
"""New places on a surface for strands and points that exist already."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..reading import attributes, ragged_rows, splines, transform
from . import live_attributes, seals
from .followers import domain_of, element_called, holder_of, is_placed, live_modifier_of
from .places import NOWHERE, ROOT_KINDS, Places
from .posed_surface import transformed

TYPES = ("CURVES", "MESH", "POINTCLOUD")
_NOTHING = {ids.FACE: NOWHERE, ids.UV: 0.0, ids.REST_ROOT: 0.0, ids.REST_ROTATION: 0.0}


class Elements:
    """The strands or points of an object, and what it stores about their places. What follows live
    is shown in its place of this frame; `at_rest` takes its shape at rest instead.
    """

    def __init__(self, ob: bpy.types.Object, at_rest: bool = False) -> None:
        self.ob, self.domain = ob, domain_of(ob)
        holder = self.read_holder()
        if ob.type in TYPES:
            kinds = ROOT_KINDS | ({ids.SEAL: seals.KIND} if ob.type == "MESH" else {})
            attributes.check_names(ob, kinds, self.domain)
        self.matrix = transform.world_matrix(ob)
        self._stores_rest = at_rest and live_modifier_of(ob) is not None
        if ids.POSITION not in holder.attributes:
            raise RefusalError(f"{ob.name} has no points")
        is_curve = ob.type == "CURVE"  # its table has the points as they were when it was bound
        self._points = splines.positions(ob.data) if is_curve else self.read_shape(ids.POSITION)
        self.sizes = np.ones(len(self._points), np.int64)
        if ob.type == "CURVES":
            self.sizes = np.empty(len(ob.data.curves), np.int32)
            ob.data.curves.foreach_get("points_length", self.sizes)
        self.count = len(self.sizes)
        if not self.count:
            raise RefusalError(f"{ob.name} has no points")
        self.broken = seals.are_broken(holder)
        self.has_place = np.zeros(self.count, bool)
        if is_placed(ob):
            self.has_place[self.places.rows] = True

    def read_holder(self) -> bpy.types.ID:
        """Reads from the object which data stores its places, and returns it."""
        holder = holder_of(self.ob)
        if holder is None:
            raise RefusalError(f"{self.ob.name} is neither hair, nor points, nor a mesh")
        self.data = holder
        return holder

    def called(self, row: int) -> str:
        """Returns what an element is called at the beginning of a message."""
        return element_called(self.ob, row)

    @property
    def places(self) -> Places:
        """The locations as they are stored."""
        return Places.among({name: self.read(name) for name in ROOT_KINDS})

    def read(self, name: str) -> np.ndarray:
        """Returns a stored attribute of the places; zeros, or no face, where there is none yet."""
        if name in self.data.attributes:
            values = attributes.read(self.data, name)
            if name == ids.FACE and self.broken is not None:
                values[self.broken] = NOWHERE
            return values
        kind = attributes.LAYOUTS[ROOT_KINDS[name]]
        shape = (self.count,) if kind.width == 1 else (self.count, kind.width)
        return np.full(shape, _NOTHING[name], kind.dtype)

    def rest_name(self, name: str) -> str:
        """Returns the name of the attribute that holds another one in the shape of these
        elements.
        """
        return live_attributes.rest_name(name) if self._stores_rest else name

    def read_shape(self, name: str) -> np.ndarray:
        return attributes.read(self.data, self.rest_name(name))

    def first_points(self) -> np.ndarray:
        """Returns the first points of strands, or the points themselves, in the world (n, 3)."""
        first = self._points[ragged_rows.starts(self.sizes)]
        return transformed(self.matrix, first.astype(np.float64))

    def roots(self) -> np.ndarray:
        """Returns the roots in the world (n, 3): those at rest, or where an element has no place,
        the first point of the strand, or the point itself.
        """
        at_rest = transformed(self.matrix, self.read(ids.REST_ROOT).astype(np.float64))
        return np.where(self.has_place[:, None], at_rest, self.first_points())


@dataclass
class Relocation:
    """New values of the attributes of one data-block. `lost` are the elements that lose their
    place, `distances` the lengths in world units by which the roots of all others have moved.
    """

    elements: Elements
    values: dict[str, np.ndarray] = field(default_factory=dict)
    lost: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    distances: np.ndarray = field(default_factory=lambda: np.empty(0))

    @property
    def data(self) -> bpy.types.ID:
        return self.elements.data

    @property
    def places(self) -> Places:
        """The locations as they will be."""
        return Places.among({name: self._value(name) for name in ROOT_KINDS})

    def put(self, name: str, rows: np.ndarray, values: np.ndarray | int) -> None:
        """Changes a stored attribute of some elements."""
        if name not in self.values:
            self.values[name] = self.elements.read(name).copy()
        self.values[name][rows] = values

    def write(self) -> None:
        for name, values in self.values.items():
            stored = self.data.attributes.get(name)
            kind = stored.data_type if stored else ROOT_KINDS[name]
            domain = stored.domain if stored else self.elements.domain
            attributes.write(self.data, name, kind, domain, values)
        seals.seal(self.data, self.places.rows)
        self.data.update_tag()

    def _value(self, name: str) -> np.ndarray:
        return self.values[name] if name in self.values else self.elements.read(name)
