# SPDX-License-Identifier: GPL-3.0-or-later
"""How the properties of the operator pose what stands on points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ..placing.rotations import WorldSpace
from ..placing.scatter_operator import Ground
from ..sources import steering
from ..sources.index import Members
from .orientation import Pose
from .steering import SIGNED, STEERED

MEMBERS = "members"  # the source of these, among those that the region holds
_STREAM = 5  # of random numbers; points/orientation.py has others


def size_of(collection: bpy.types.Collection) -> int:
    """Returns the number of members that nodes see."""
    return len(collection.objects) + len(collection.children)


@dataclass(frozen=True)
class Settings:
    """The operator's properties, which may be gone while the points are made."""

    seed: int
    scale: float
    random_scale: float
    rotation: float
    random_rotation: float
    tilt: np.ndarray
    random: float
    lean: float | None  # the angle by which the Z axis leans into the flow; None: X follows it
    members: int  # of the collection; 0: there is none

    @classmethod
    def of(cls, operator: Any) -> Settings:
        by_z = operator.flow_axis == "Z"
        is_collection = operator.instances == "COLLECTION"
        return cls(
            operator.seed,
            operator.scale,
            operator.random_scale,
            operator.rotation,
            operator.random_rotation,
            np.array(operator.tilt),
            operator.random,
            operator.flow_angle if by_z else None,
            size_of(bpy.data.collections[operator.collection]) if is_collection else 0,
        )


class Posed:
    """How instances are posed at the places of points."""

    def __init__(self, ground: Ground, space: WorldSpace, settings: Settings) -> None:
        region = ground.region
        self._settings = settings
        self._face = ground.locations.face
        self._uv = ground.locations.uv.astype(np.float64)
        self._sources = steering.Steering(
            region.sources, region.cage, region.surface, STEERED, SIGNED
        )
        flow = self._sources.flow(self._face, self._uv)
        self._flow = None if flow is None else _in_object(flow, space)
        index = region.sources.get(MEMBERS)
        self._members: Members | None = index.on(region.surface) if index else None

    def of(self, rows: slice) -> Pose:
        settings = self._settings
        factors = self._sources.factors(self._face[rows], self._uv[rows])
        flow = None if self._flow is None else self._flow[rows]
        leans = settings.lean is not None
        random = factors["random"]
        return Pose(
            along=None if leans else flow,
            into=settings.lean * flow if leans and flow is not None else None,
            rotation=settings.rotation * factors["rotation"],
            tilt=settings.tilt * factors["tilt"],
            scale=settings.scale * factors["scale"],
            random=settings.random * random,
            random_rotation=settings.random_rotation * random,
            random_scale=(settings.random_scale * random).clip(max=1),
        )

    def members(self) -> np.ndarray | None:
        """Returns a member of the collection for each point, at random where no source says
        which.
        """
        count = self._settings.members
        if not count:
            return None
        if self._members is None:
            rng = np.random.default_rng([self._settings.seed, _STREAM])
            return rng.integers(count, size=len(self._face), dtype=np.int32)
        return self._members(self._face, self._uv, count)


def _in_object(flow: np.ndarray, space: WorldSpace) -> np.ndarray:
    """Returns vectors of the same lengths, whose directions are in the object's space."""
    local = space.to_local(flow)
    length = np.linalg.norm(local, axis=1, keepdims=True)
    wanted = np.linalg.norm(flow, axis=1, keepdims=True)
    return local * np.divide(wanted, length, out=np.zeros_like(wanted), where=length > 0)
