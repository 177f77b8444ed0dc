# SPDX-License-Identifier: GPL-3.0-or-later
"""The limit surface that maps are made of, and its quantities at some of its places."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..images import texel_places
from ..reading import cage

if TYPE_CHECKING:
    import limitsurf


class Body:
    """A limit surface, in its object's space or as it lies in the world."""

    def __init__(self, found: cage.Cage, whose: str, *, in_world: bool) -> None:
        self.surface = found.surface(in_world=in_world)
        self.uv_map = texel_places.uv_data(self.surface, found, whose)
        self.outward = -1.0 if in_world and found.is_mirrored else 1.0

    @cached_property
    def bounds(self) -> np.ndarray:
        """The lowest and the highest coordinates (2, 3)."""
        return self.surface.bounds()

    @property
    def size(self) -> float:
        """The length of the diagonal of the bounding box."""
        return float(np.linalg.norm(self.bounds[1] - self.bounds[0]))


class Places:
    """Some locations on a body. Each quantity is calculated when it is first asked for."""

    def __init__(self, body: Body, face: np.ndarray, uv: np.ndarray, radius: float) -> None:
        self.body, self.face, self.uv, self._radius = body, face, uv, radius

    @cached_property
    def position(self) -> np.ndarray:
        return self.body.surface.evaluate(self.face, self.uv, dtype=np.float32).position

    @cached_property
    def normal(self) -> np.ndarray:
        """Unit normals that point outward and are always finite."""
        frames = self.body.surface.frames(self.face, self.uv)
        return self.body.outward * frames[:, :, 2]

    @cached_property
    def curvature(self) -> limitsurf.Curvature:
        return self.body.surface.curvature(
            self.face, self.uv, irregular="average", radius=self._radius
        )

    @cached_property
    def mean(self) -> np.ndarray:
        """Mean curvature, which is negative where the surface bulges outwards."""
        return self.body.outward * self.curvature.mean

    @cached_property
    def principal(self) -> tuple[np.ndarray, np.ndarray]:
        """The larger and the smaller principal curvature."""
        c = self.curvature
        return (c.k1, c.k2) if self.body.outward > 0 else (-c.k2, -c.k1)

    @cached_property
    def directions(self) -> tuple[np.ndarray, np.ndarray]:
        """The principal directions as unit vectors. Of the two opposite vectors each is the one
        that goes up the map's U.
        """
        c = self.curvature
        both = c.direction1, c.direction2
        frames = self.body.surface.tangent_frames(self.body.uv_map, self.face, self.uv)
        against = [np.einsum("ni,ni->n", of, frames[:, :, 0]) < 0 for of in both]
        found = [np.where(down[:, None], -of, of) for of, down in zip(both, against, strict=True)]
        larger, smaller = found if self.body.outward > 0 else found[::-1]
        return larger, smaller

    @cached_property
    def distortion(self) -> limitsurf.MapDistortion:
        return self.body.surface.map_distortion(self.body.uv_map, self.face, self.uv)
