# SPDX-License-Identifier: GPL-3.0-or-later
"""The colors that an image gives to places of the surface, for each way of projecting it.

The work is on arrays alone; Blender's data is not touched here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np

from .. import native
from ..reading.projector import Projector
from .world import WorldSurface

if TYPE_CHECKING:
    import limitsurf


@dataclass(frozen=True)
class Places:
    """Texels, given by the locations under their centres."""

    uv_map: limitsurf.SurfaceData
    face: np.ndarray  # (n,)
    uv: np.ndarray  # (n, 2)
    texel: tuple[float, float]  # the size of a texel on the UV map

    def take(self, rows: slice) -> Places:
        return Places(self.uv_map, self.face[rows], self.uv[rows], self.texel)


class Source(Protocol):
    @property
    def unreached(self) -> str:
        """The reasons for which no part of the image may reach the surface, or none."""

    def check(self) -> None:
        """Raises RefusalError where the inputs make a projection impossible."""

    def look(self, places: Places) -> tuple[np.ndarray, np.ndarray]:
        """Returns colors (n, 4) with straight alpha, and weights (n,)."""


@dataclass(frozen=True)
class Seen:
    """The settings that decide on which places an image falls, and with which weight."""

    facing: tuple[float, float]  # the two angles of Facing
    two_sided: bool
    occlusion: bool
    samples: Literal[1, 4, 16]
    soft_edge: float
    is_framed: bool  # true if nothing lies outside the image


@dataclass(frozen=True)
class FromProjector:
    world: WorldSurface
    projector: Projector
    image: limitsurf.FilteredImage
    seen: Seen
    unreached: str

    def check(self) -> None:
        self.world.check_eye(self.projector)

    def look(self, places: Places) -> tuple[np.ndarray, np.ndarray]:
        found = self.world.surface.project(
            places.uv_map,
            places.face,
            places.uv,
            self.world.clip_matrix(self.projector),
            places.texel,
            facing=self.seen.facing,
            two_sided=self.seen.two_sided,
            occlusion=self.seen.occlusion,
            samples=self.seen.samples,
            soft_edge=self.seen.soft_edge,
            frame=self.seen.is_framed,
            depth=(-1.0, 1.0),
        )
        return self.image.sample(found.st, found.footprint), found.weight


@dataclass(frozen=True)
class FromBox:
    """Projects from all six sides at once, blended by the normal. No side hides another."""

    world: WorldSurface
    to_box: np.ndarray  # the matrix from the world
    proportions: np.ndarray  # (2,) shares of a side that the image fills
    image: limitsurf.FilteredImage
    blend: float
    is_framed: bool

    @property
    def unreached(self) -> str:
        return "the surface may lie outside the empty's box" if self.is_framed else ""

    def check(self) -> None:
        pass

    def look(self, places: Places) -> tuple[np.ndarray, np.ndarray]:
        surface, to_box = self.world.surface, self.to_box @ np.linalg.inv(self.world.from_world)
        normals = surface.frames(places.face, places.uv)[:, :, 2]
        shares = native.limitsurf.box_weights(normals, self.blend, to_box)
        stretch = np.diag([*(1 / self.proportions), 1, 1])
        total, weight = np.zeros((len(shares), 4)), np.zeros(len(shares))
        for side, share in zip(native.limitsurf.box_sides(to_box), shares.T, strict=True):
            rows = np.flatnonzero(share)
            if not rows.size:
                continue
            found = surface.project(
                places.uv_map,
                places.face[rows],
                places.uv[rows],
                stretch @ side,
                places.texel,
                facing=(np.pi / 2, np.pi / 2),
                two_sided=True,
                occlusion=False,
                frame=self.is_framed,
                depth=None,
            )
            colors = self.image.sample(found.st, found.footprint)
            part = share[rows] * found.weight
            covers = part * colors[:, 3]
            total[rows, :3] += covers[:, None] * colors[:, :3]
            total[rows, 3] += covers
            weight[rows] += part
        alpha = total[:, 3:]
        total[:, :3] /= np.where(alpha > 0, alpha, 1)
        total[:, 3] /= np.where(weight > 0, weight, 1)
        return total.astype(np.float32), weight.clip(0, 1)


@dataclass(frozen=True)
class AlongNormals:
    """Projects the image of another surface, from the points where rays along the normals meet that
    surface.
    """

    world: WorldSurface
    carrier: WorldSurface
    carrier_map: limitsurf.SurfaceData
    image: limitsurf.FilteredImage
    max_distance: float
    direction: Literal["both", "outward", "inward"]
    carrier_name: str

    @property
    def unreached(self) -> str:
        where = " in the chosen direction" if self.direction != "both" else ""
        near = " within the chosen distance" if np.isfinite(self.max_distance) else ""
        both = " and" if where and near else ""
        return f"no normal of the surface meets {self.carrier_name}{where}{both}{near}"

    def check(self) -> None:
        pass

    def look(self, places: Places) -> tuple[np.ndarray, np.ndarray]:
        found = self.world.surface.project_along_normals(
            places.uv_map,
            places.face,
            places.uv,
            self.carrier.surface,
            self.carrier_map,
            places.texel,
            max_distance=self.max_distance,
            direction=self.direction,
            transform=self.carrier.from_world @ np.linalg.inv(self.world.from_world),
        )
        return self.image.sample(found.st, found.footprint), found.weight
