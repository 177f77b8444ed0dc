# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected points of objects in Edit Mode, whatever the objects' type."""

from abc import ABC, abstractmethod

import bpy
import numpy as np

from ..placing.posed_surface import transformed
from ..placing.rotations import WorldSpace, unit
from .aim import Elements, Placement
from .choices import Choices, Outcome


class SnappedPoints(ABC):
    """Snaps the selected points of an object. A subclass reads all points in the object's own
    space, and moves some of them.
    """

    noun = ""
    stores_location = False

    def __init__(self, ob: bpy.types.Object) -> None:
        self.ob = ob
        self._matrix = np.array(ob.matrix_world, np.float64)
        self._space = WorldSpace(self._matrix, ob.name)
        points, selected = self.read()
        self._rows = np.flatnonzero(selected)
        self._points = transformed(self._matrix, points[self._rows].astype(np.float64))

    @property
    def follower(self) -> bpy.types.Object | None:
        return self.ob if self.ob.type == "CURVE" else None

    @abstractmethod
    def read(self) -> tuple[np.ndarray, np.ndarray]:
        """Returns all points (n, 3), and whether each is selected (n,)."""

    @abstractmethod
    def move(self, rows: np.ndarray, moves: np.ndarray) -> None:
        """Adds offsets (k, 3) to some of the points."""

    def normals(self, rows: np.ndarray) -> np.ndarray:
        """Returns normals (k, 3) in world space: the object's Z, for points that have none of their
        own.
        """
        return np.broadcast_to(self._axes()[:, 2], (len(rows), 3))

    def elements(self) -> Elements:
        return Elements(self._points, lambda: self.normals(self._rows), self._axes())

    def place(self, placement: Placement, choices: Choices) -> Outcome:
        moves = placement.position - self._points[placement.rows]
        self.move(self._rows[placement.rows], self._space.to_local(moves))
        outcome = Outcome(self.noun, [np.linalg.norm(moves, axis=1)])
        if choices.align != "NONE":
            outcome.notes.append(f"{self.noun} have no rotation to align")
        return outcome

    def normals_in_world(self, normals: np.ndarray) -> np.ndarray:
        """Returns in world space the normals that are given in the object's space."""
        return unit(np.linalg.solve(self._matrix[:3, :3].T, normals.T).T)

    def _axes(self) -> np.ndarray:
        return unit(self._matrix[:3, :3].T).T
