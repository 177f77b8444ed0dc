# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair curves: their roots are put on the surface, and bound to it as those of new hair are."""

import bpy
import numpy as np

from .. import ids, native
from ..counting import by_count, counted
from ..errors import RefusalError
from ..placing.followers import followed_surface, sharers
from ..placing.posed_surface import transformed
from ..placing.present_shape import PresentShape
from ..placing.rotations import WorldSpace, unit
from ..reading import attributes, ragged_rows
from ..tasks.editable import check_data_editable
from .aim import Elements, Placement
from .binding_again import will_follow
from .choices import Choices, Outcome
from .hair_binding import HairBinding
from .strands import Strands
from .surface import TargetSurface

_HANDLES = (ids.HANDLE_LEFT, ids.HANDLE_RIGHT)  # of Bézier hair


class SnappedHair:
    """Snaps the strands of a Curves object: all of them, or in its own modes those that are
    selected.
    """

    noun = "strands"
    stores_location = True

    def __init__(self, ob: bpy.types.Object, surface: TargetSurface, selected_only: bool) -> None:
        check_data_editable(ob.data)
        _check_sharers(ob, surface.ob)
        self._ob = ob
        self._shape = PresentShape(ob, bpy.context.evaluated_depsgraph_get())
        self._read_transform()
        self._sizes = np.empty(len(ob.data.curves), np.int32)
        ob.data.curves.foreach_get("points_length", self._sizes)
        chosen = np.ones(len(self._sizes), bool)
        if selected_only:
            chosen = _selected(ob.data, self._sizes)
        self._chosen = np.flatnonzero(chosen)
        self._binding = HairBinding(self._shape, surface, is_whole=bool(chosen.all()))

    @property
    def follower(self) -> bpy.types.Object:
        return self._ob

    def elements(self) -> Elements:
        strands, _rows = self._strands(self._chosen)
        axes = unit(self._matrix[:3, :3].T).T
        return Elements(strands.points[strands.root], strands.directions, axes)

    def place(self, placement: Placement, choices: Choices) -> Outcome:
        outcome = Outcome(self.noun)
        curves = self._chosen[placement.rows]
        strands, _rows = self._strands(curves)
        outcome.distances.append(
            np.linalg.norm(placement.position - strands.points[strands.root], axis=1)
        )
        self._read_transform()  # its parents may have been snapped just now
        strands, rows = self._strands(curves)
        turn = self._turns(curves, strands, placement, choices.align, outcome)
        self._move(strands, rows, placement, turn, choices)
        follows = will_follow(self._ob, self._binding.target, choices.follow)
        outcome.notes += self._binding.write(
            curves, placement.face, placement.uv, self._matrix, follows
        )
        self._ob.data.update_tag()
        return outcome

    def _read_transform(self) -> None:
        self._matrix = np.array(self._ob.matrix_world, np.float64)
        self._space = WorldSpace(self._matrix, self._ob.name)

    def _strands(self, curves: np.ndarray) -> tuple[Strands, np.ndarray]:
        """Returns the strands in world space, and the rows of their points."""
        taken = np.zeros(len(self._sizes), bool)
        taken[curves] = True
        rows = np.flatnonzero(np.repeat(taken, self._sizes))
        points = self._shape.read(ids.POSITION)[rows].astype(np.float64)
        return Strands(transformed(self._matrix, points), self._sizes[curves]), rows

    def _turns(
        self,
        curves: np.ndarray,
        strands: Strands,
        placement: Placement,
        align: str,
        outcome: Outcome,
    ) -> np.ndarray:
        """Returns rotations (m, 3, 3) in world space."""
        if align == "NONE":
            return np.broadcast_to(np.eye(3), (len(curves), 3, 3))
        turn = native.limitsurf.shortest_turns(strands.directions(), placement.frame[:, :, 2])
        if align == "NORMAL_DU":
            bound, rest = self._binding.rest_frames(curves)
            place = self._binding.places(placement.face, placement.uv, self._matrix)
            old, new = (self._space.frames(frame[bound]) for frame in (rest, place.frame))
            turn[bound] = new @ np.swapaxes(old, 1, 2)
            if not bound.all():
                loose = np.count_nonzero(~bound)
                outcome.notes.append(
                    f"{counted(loose, 'strands', 'was', 'were')} not bound to a surface and "
                    f"{by_count(loose, 'was', 'were')} only turned to the normal"
                )
        return turn

    def _move(
        self,
        strands: Strands,
        rows: np.ndarray,
        placement: Placement,
        turn: np.ndarray,
        choices: Choices,
    ) -> None:
        weights = strands.weights(choices.hair)
        moves = strands.moves(strands.points, placement.position, turn, weights)
        regained = np.zeros_like(moves)
        if choices.keep_length and choices.hair != "STRAND":
            moved = strands.points + moves
            regained = strands.restored_lengths(moved) - moved
        for name in _HANDLES:
            if name in self._ob.data.attributes:
                handles = self._shape.read(name)[rows].astype(np.float64)
                own = transformed(self._matrix, handles)
                own_moves = strands.moves(own, placement.position, turn, weights)
                self._write(name, rows, handles + self._space.to_local(own_moves + regained))

        points = self._shape.read(ids.POSITION)[rows].astype(np.float64)
        points += self._space.to_local(moves + regained)
        # The roots are put exactly where the stored locations say, to the last bit.
        bound = self._binding.places(placement.face, placement.uv, self._matrix).position
        off = placement.position - transformed(self._matrix, bound)
        points[strands.root] = bound + self._space.to_local(off)
        self._write(ids.POSITION, rows, points)

    def _write(self, name: str, rows: np.ndarray, values: np.ndarray) -> None:
        stored = attributes.read(self._ob.data, name)
        stored[rows] = values
        attributes.write(self._ob.data, name, "FLOAT_VECTOR", "POINT", stored)


def _check_sharers(ob: bpy.types.Object, target: bpy.types.Object) -> None:
    """Raises RefusalError where the same strands follow another surface by another object: their
    places cannot be on both.
    """
    for other in sharers(ob):
        theirs = followed_surface(other)
        if theirs not in (None, target):
            raise RefusalError(
                f"{ob.name} shares its data with {other.name}, which follows {theirs.name}: make "
                "one of them a single-user copy first"
            )


def _selected(data: bpy.types.Curves, sizes: np.ndarray) -> np.ndarray:
    """Tells for each curve (m,) whether any part of it is selected."""
    if ids.SELECTION not in data.attributes:
        return np.ones(len(sizes), bool)
    selected = attributes.read(data, ids.SELECTION) > 0
    if data.attributes[ids.SELECTION].domain == "CURVE":
        return selected
    return np.logical_or.reduceat(selected, ragged_rows.starts(sizes))
