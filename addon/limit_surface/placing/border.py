# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders of a surface along which things are placed, and their directions there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import bpy
import numpy as np
from mathutils import Matrix

from .. import ids
from ..counting import counted
from ..errors import RefusalError
from ..reading import attributes
from ..tasks.job import Progress
from .rotations import WorldSpace, unit

if TYPE_CHECKING:
    import limitsurf

#: The edges of a border: those that the library finds itself, or the two vertices of each
Edges = Literal["boundary", "creases"] | np.ndarray

MOST_ROWS_NAMED = 3

_MISSING = {
    "BOUNDARY": "has no open boundary: each of its edges is between two faces",
    "CREASES": "has no creased edges",
    "SHARP": "has no edges that are marked sharp",
    "SELECTED": "has no selected edges",
}


@dataclass(frozen=True)
class BorderChoice:
    """The choice of the edges along which things are placed."""

    source: str  # BOUNDARY, CREASES, SHARP or SELECTED

    def read(self, mesh: bpy.types.Mesh, whose: str) -> Edges:
        """Reads the edges from the cage's mesh. Raises RefusalError where none is chosen."""
        if self.source == "BOUNDARY":
            return "boundary"
        if self.source == "CREASES":
            return "creases"
        chosen = _selected(mesh) if self.source == "SELECTED" else _sharp(mesh)
        if not chosen.any():
            raise RefusalError(self.missing(whose))
        of_faces = np.zeros(len(mesh.edges), bool)
        of_faces[attributes.read(mesh, ids.CORNER_EDGE)] = True
        if not (chosen & of_faces).any():
            raise RefusalError(f"{whose}: the chosen edges belong to no face")
        return attributes.read(mesh, ids.EDGE_VERTICES)[chosen & of_faces]

    def missing(self, whose: str) -> str:
        return f"{whose} {_MISSING[self.source]}"


def borders(count: int) -> str:
    """Returns the number of borders for reports."""
    return counted(count, "borders")


def where_rows_end(ended: np.ndarray, asked_for: int) -> str:
    """Returns a sentence about the rows that lack things, or nothing. `ended` holds how many each
    row lacks of those that were asked for.
    """
    short = np.flatnonzero(ended)
    if not len(short):
        return ""
    lacking = [f"{ended[row]:,} in row {row + 1}" for row in short[:MOST_ROWS_NAMED]]
    others = short[MOST_ROWS_NAMED:]
    if len(others):
        lacking.append(f"{ended[others].sum():,} in the other rows")
    return (
        "some rows are shorter, because the surface ends or rows would meet (missing of "
        f"{asked_for:,}: {', '.join(lacking)})"
    )


def _selected(mesh: bpy.types.Mesh) -> np.ndarray:
    stored = mesh.attributes.get(ids.EDGE_SELECTION)
    if stored is None or stored.data_type != "BOOLEAN":  # Blender 5.0 gives it a wrong type
        return np.zeros(len(mesh.edges), bool)
    return attributes.read(mesh, ids.EDGE_SELECTION)


def _sharp(mesh: bpy.types.Mesh) -> np.ndarray:
    if ids.SHARP_EDGE not in mesh.attributes:
        return np.zeros(len(mesh.edges), bool)
    return attributes.read(mesh, ids.SHARP_EDGE)


@dataclass(frozen=True)
class Amount:
    """Exactly one of them is given."""

    count: int | None = None
    spacing: float | None = None


@dataclass(frozen=True)
class BorderLayout:
    """How things are laid out along a border."""

    jitter: float
    side: Literal["left", "right"]  # whose faces they stand on
    rows: int
    row_distance: float  # in world units

    def scatter(
        self,
        surface: limitsurf.LimitSurface,
        curves: limitsurf.EdgeCurves,
        amount: Amount,
        seed: int,
        progress: Progress,
    ) -> limitsurf.AlongCurves:
        return surface.scatter_along(
            curves,
            count=amount.count,
            spacing=amount.spacing,
            jitter=self.jitter,
            seed=seed,
            side=self.side,
            rows=self.rows,
            row_distance=self.row_distance,
            progress=progress,
        )


@dataclass(frozen=True)
class BorderDirections:
    """Directions at places along a border, in the world."""

    outward: np.ndarray  # (n, 3): away from the faces on which the places are
    along: np.ndarray  # (n, 3)
    turn: Turn

    def at(self, rows: np.ndarray) -> BorderDirections:
        return BorderDirections(self.outward[rows], self.along[rows], self.turn)

    def in_world(self, rows: slice, normal: np.ndarray) -> np.ndarray:
        """Returns the frames (n, 3, 3) of things in the world: their last column is the direction
        of a thing, the first one lies between this and outwards, the second one runs along the
        border. `normal` (n, 3) are the surface's normals in the world.
        """
        frame = np.stack([self.outward[rows], self.along[rows], normal], axis=2)
        return frame @ self.turn.matrix()

    def in_surface_space(self, rows: slice, normal: np.ndarray, space: WorldSpace) -> np.ndarray:
        """Returns rotations (n, 3, 3) in the surface's own space, with the same columns."""
        along = unit(space.to_local(self.along[rows]))
        outward = np.cross(along, normal)
        wanted = space.to_local(self.outward[rows])
        side = np.sign(np.einsum("ni,ni->n", outward, wanted))[:, None]
        frame = np.stack([side * outward, side * along, normal], axis=2)
        return frame @ self.turn.matrix()


@dataclass(frozen=True)
class Turn:
    """How things lean: from the normal outwards and along the border."""

    outwards: float  # radians from the normal
    flow: float  # radians towards the border's direction

    def matrix(self) -> np.ndarray:
        """Returns the rotation in coordinates (outward, along, normal)."""
        turned = Matrix.Rotation(self.outwards, 3, "Y") @ Matrix.Rotation(-self.flow, 3, "X")
        return np.array(turned, np.float64)
