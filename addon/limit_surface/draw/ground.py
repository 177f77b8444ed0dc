# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface on which strokes lie, in world space."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..errors import RefusalError
from ..placing import following
from ..placing.posed_surface import PosedSurface, transformed
from ..reading import cage
from ..tasks.refused_faces import check_some_left
from .stroke import Stroke

if TYPE_CHECKING:
    import limitsurf

#: The tolerance unless another one is chosen, as a share of the surface's extent
AUTOMATIC = 1e-4
#: The smallest tolerance, as a share of the extent: Blender's single precision holds no better one.
LEAST = 1e-6
#: Paths are laid more closely than curves are fitted to them.
PATH = 0.25
#: The longest step of a path, as a share of the extent: narrow features between two points of a
#: path could be missed.
STEP = 0.01

#: How far the surface may be from a mirrored place, as shares of its extent. Sculpts are not quite
#: symmetric, so it may be above or below it. It may hardly be beside it, which is where the surface
#: ends before it comes there: on a half, strokes would be pressed together along the border.
MIRROR_ABOVE, MIRROR_BESIDE = 0.03, 0.005


class Ground:
    def __init__(
        self,
        ob: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        found: cage.Cage | None = None,
    ) -> None:
        """The cage is read unless it has been found before."""
        self.ob = ob
        self.posed = PosedSurface(found or cage.read(ob, depsgraph))
        self.surface: limitsurf.LimitSurface = self.posed.in_world
        check_some_left(self.surface, ob.name)
        self.matrix = self.posed.cage.matrix
        #: the sign of the outward normal: the world's surface of a mirrored object is inside out
        self.outward = -1.0 if self.posed.cage.is_mirrored else 1.0
        low, high = self.surface.bounds()
        self.size = float(np.linalg.norm(high - low))
        if not self.size > 0:
            raise RefusalError(f"All points of {ob.name} lie at one place")

    def now(self, ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Ground:
        """Returns the ground of the same object as it is by now. Raises RefusalError if its faces
        have changed, so that locations on them mean other places.
        """
        before, found = self.posed.cage, cage.read(ob, depsgraph)
        signatures = following.signature(before), following.signature(found)
        if not following.have_same_faces(*signatures):
            raise RefusalError(
                f"The faces of {ob.name} have changed meanwhile: the strokes have no place on it"
            )
        is_same = (
            np.array_equal(before.matrix, found.matrix)
            and np.array_equal(before.mesh.positions, found.mesh.positions)
            and signatures[0] == signatures[1]
        )
        return self if is_same else Ground(ob, depsgraph, found)

    def tolerance(self, chosen: float) -> float:
        """Returns the tolerance in world units; 0 chooses one by the surface's size."""
        return max(chosen, LEAST * self.size) if chosen else AUTOMATIC * self.size

    def stroke(
        self, face: np.ndarray, uv: np.ndarray, radius: np.ndarray, is_closed: bool = False
    ) -> Stroke:
        uv = np.asarray(uv, np.float64).reshape(-1, 2)
        on = self.surface.evaluate(face, uv, derivatives=1)
        assert on.normal is not None
        normal = self.outward * on.normal
        return Stroke(np.asarray(face, np.int32), uv, radius, on.position, normal, is_closed)

    def again(self, stroke: Stroke) -> Stroke:
        """Returns a stroke of another pose of the surface at the same locations."""
        moved = self.stroke(stroke.face, stroke.uv, stroke.radius, stroke.is_closed)
        return replace(moved, spline=stroke.spline)

    def lay(
        self,
        points: np.ndarray,
        radius: np.ndarray,
        tolerance: float,
        is_closed: bool = False,
        handles: tuple[np.ndarray, np.ndarray] | None = None,
        max_step: float = np.inf,
    ) -> list[Stroke]:
        """Lays the curve through points (n, 3) of the world onto the surface: in several pieces
        where it cannot be laid in one.
        """
        left, right = handles or (None, None)
        laid = self.surface.lay_path(
            points,
            PATH * tolerance,
            handle_left=left,
            handle_right=right,
            closed=is_closed,
            max_step=min(max_step, STEP * self.size),
        )
        places = np.arange(len(points) + 1)
        radii = np.interp(laid.place, places, np.append(radius, radius[0]))
        return [
            self.stroke(laid.face[rows], laid.uv[rows], radii[rows], bool(closed))
            for begin, end, closed in zip(
                laid.offsets[:-1], laid.offsets[1:], laid.closed, strict=True
            )
            for rows in [slice(begin, end)]
            if end > begin + 1
        ]

    def laid_again(
        self, stroke: Stroke, tolerance: float, max_step: float = np.inf
    ) -> list[Stroke]:
        """Lays the stroke through its own points, which stay points of it."""
        points, radius = stroke.position, stroke.radius
        if stroke.is_closed:  # the last point repeats the first
            points, radius = points[:-1], radius[:-1]
        return self.lay(points, radius, tolerance, stroke.is_closed, max_step=max_step)

    def mirrored(self, points: np.ndarray) -> np.ndarray:
        """Returns points (n, 3) of the world mirrored along the X axis of the surface's object."""
        flip = self.matrix @ np.diag([-1.0, 1.0, 1.0, 1.0]) @ np.linalg.inv(self.matrix)
        return transformed(flip, points)

    def mirror_places(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns the places (n, 3) of the surface that mirror points of it, and whether the
        surface is there at all.
        """
        wanted = self.mirrored(points)
        hits = self.surface.closest(wanted)
        normal = self.surface.frames(hits.face, hits.uv)[:, :, 2]
        arm = wanted - hits.position
        above = np.einsum("ij,ij->i", arm, normal)
        beside = np.linalg.norm(arm - above[:, None] * normal, axis=1)
        is_there = np.abs(above) <= MIRROR_ABOVE * self.size
        return hits.position, is_there & (beside <= MIRROR_BESIDE * self.size)

    def mirror_image(self, stroke: Stroke, tolerance: float) -> tuple[list[Stroke], bool]:
        """Returns the mirror image of a stroke, as far as the surface is there, and whether it is
        there everywhere.
        """
        _places, is_there = self.mirror_places(stroke.position)
        pieces = stroke.pieces(is_there)
        laid = [each for piece in pieces for each in self._mirror_stroke(piece, tolerance)]
        return laid, bool(is_there.all())

    def _mirror_stroke(self, stroke: Stroke, tolerance: float) -> list[Stroke]:
        points, radius = self.mirrored(stroke.position), stroke.radius
        if stroke.is_closed:
            points, radius = points[:-1], radius[:-1]
        return self.lay(points, radius, tolerance, stroke.is_closed)
