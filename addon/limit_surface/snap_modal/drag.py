# SPDX-License-Identifier: GPL-3.0-or-later
"""The dragging of one thing over the surface: the state between two moves of the mouse."""

from dataclasses import dataclass
from functools import cached_property

import bpy
import numpy as np

from .. import native
from ..errors import RefusalError
from ..snap.surface import TargetSurface
from ..viewport.ray import Ray
from .borders import Borders
from .handles import Handle, Place

LOCKS = ("FREE", "BORDER", "BOUNDARY")
# number of elements nearest on screen that are tested; the nearest one that is not hidden is taken
PICKED_AMONG = 32
# as a share of the distance: the surface hides a point if it is nearer by more than this
IN_FRONT = 1e-3


@dataclass(frozen=True)
class Bending:
    """The principal directions and curvatures at a place; directions are missing where there are
    none.
    """

    directions: tuple[np.ndarray, ...]  # (3,) world
    curvatures: tuple[float, float]


class Glide:
    """A location on a surface that follows the mouse."""

    def __init__(self, surface: TargetSurface) -> None:
        self.surface = surface
        self.lock = "FREE"
        self.face, self.uv = -1, np.full(2, np.nan)

    @cached_property
    def borders(self) -> Borders:
        return Borders(self.surface)

    def prepare(self) -> None:
        """Builds the search structure now, not at the first move of the mouse."""
        self.surface.in_world.ray_cast(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))

    @property
    def is_on_surface(self) -> bool:
        return self.face >= 0

    def go_to(self, face: int, uv: np.ndarray) -> None:
        """Goes to a location. (u, v) is rounded to the precision of files and properties before
        anything is evaluated.
        """
        self.face, self.uv = int(face), np.asarray(uv, np.float32).astype(np.float64)

    def follow(self, ray: Ray) -> bool:
        """Follows the mouse, and returns whether the surface is under it; if not, the location
        stays.
        """
        if self.lock == "BOUNDARY":
            self.go_to(*self.borders.nearest_of_boundary(ray))
            return True
        hit = self.surface.in_world.ray_cast(ray.origin[None], ray.direction[None])
        if hit.face[0] < 0:
            return False
        self.go_to(hit.face[0], hit.uv[0])
        if self.lock == "BORDER":
            self.go_to(*self.borders.nearest_of_face(self.face, ray))
        return True

    def place(self, offset: float) -> Place:
        found = self.surface.places(np.array([self.face]), self.uv[None], np.eye(4))
        position, frame = found.position[0], found.frame[0]
        position = position + offset * frame[:, 2]
        return Place(self.surface, self.face, self.uv, position, frame)

    def bending(self) -> Bending:
        surface = self.surface
        found = surface.in_world.curvature(np.array([self.face]), self.uv[None])
        directions = (found.direction1[0], found.direction2[0])
        return Bending(
            tuple(each for each in directions if np.isfinite(each).all()),
            (surface.outward * found.k1[0], surface.outward * found.k2[0]),
        )


class Drag:
    def __init__(self, glide: Glide, handle: Handle) -> None:
        self.glide, self.handle = glide, handle
        self.place: Place | None = None

    def put(self, offset: float, align: str, hair: str) -> None:
        if self.glide.is_on_surface:
            self.place = self.glide.place(offset)
            self.handle.put(self.place, align, hair)

    def confirm(self, offset: float, align: str, hair: str) -> None:
        """Puts the thing at its location on the surface as it is now, which may have moved since it
        was read, and leaves it there. If this raises an error, everything is restored.
        """
        try:
            self.handle.check()
            surface = self.glide.surface = self._surface_now()
            self.put(offset, align, hair)
            if surface.has_changed(bpy.context.evaluated_depsgraph_get()):
                raise self._is_depended_on()
            assert self.place is not None
            self.handle.confirm(self.place, align)
        except Exception:
            self.handle.restore()
            raise

    def _surface_now(self) -> TargetSurface:
        """Returns the surface as it is now. Raises RefusalError if it would be another one without
        what is dragged.
        """
        before = self.glide.surface
        try:
            now = before.now(bpy.context.evaluated_depsgraph_get())
        except native.refusals:
            self.handle.restore()
            before.now(bpy.context.evaluated_depsgraph_get())  # raises the reason again, or:
            raise self._is_depended_on() from None
        if now is not before:
            self.handle.restore()
            if now.has_changed(bpy.context.evaluated_depsgraph_get()):
                raise self._is_depended_on()
        return now

    def _is_depended_on(self) -> RefusalError:
        return RefusalError(
            f"{self.handle.name} cannot be put there, because {self.glide.surface.ob.name} "
            "depends on it"
        )


def offset_step(surface: TargetSurface) -> float:
    """Returns a power of ten that is at most a hundredth of the surface's extent."""
    low, high = surface.in_world.bounds()
    return float(10 ** np.floor(np.log10(np.linalg.norm(high - low) / 100)))


def nearest_in_sight(points: np.ndarray, ray: Ray, surface: TargetSurface) -> int | None:
    """Returns the row of the point that is nearest to the mouse on screen and is not behind the
    surface.
    """
    apart = np.nan_to_num(ray.apart(points), nan=np.inf, posinf=np.inf)
    nearest = np.argsort(apart)[:PICKED_AMONG] if len(apart) <= PICKED_AMONG else _least(apart)
    nearest = nearest[np.isfinite(apart[nearest])]
    if not len(nearest):
        return None
    origins, directions, lengths = ray.towards(points[nearest])
    hits = surface.in_world.ray_cast(origins, directions)
    in_sight = ~(hits.distance < (1 - IN_FRONT) * lengths)
    return int(nearest[in_sight][0]) if in_sight.any() else int(nearest[0])


def _least(values: np.ndarray) -> np.ndarray:
    rows = np.argpartition(values, PICKED_AMONG)[:PICKED_AMONG]
    return rows[np.argsort(values[rows])]
