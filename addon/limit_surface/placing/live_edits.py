# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes up what somebody has changed in hair or points that follow live: the shape at rest becomes
the one that the surface carries to where the points are, in the pose for which they were written.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator

import bpy
import numpy as np

from ..errors import RefusalError
from . import live_attributes
from .live_surface import LiveSurface, PosedSurface, surface_at
from .live_thing import LiveThing

#: What single precision adds to positions that were posed, in units of the largest coordinate
_ROUNDING = 1e-6


class Edits:
    """The edits of one object, whose surface is `on`. `needed` returns the data-blocks that follow
    live and on which the surface depends.
    """

    def __init__(
        self,
        ob: bpy.types.Object,
        thing: LiveThing,
        on: LiveSurface,
        needed: Callable[[], Collection[bpy.types.ID]],
    ) -> None:
        self._ob, self._thing, self._on, self._needed = ob, thing, on, needed
        self._edited = thing.edits(ob.data, on.limit)

    def take_up(
        self,
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        matrix: Callable[[], np.ndarray],
    ) -> None:
        """`matrix` returns the matrix from the surface's space to the object's. Raises RefusalError
        where the pose for which the points were written is not known.
        """
        if self._edited is None:
            return
        written, on = live_attributes.written(self._ob.data), self._on
        if written is None:
            self._take_up(on.posed(), matrix())
        elif self._thing.version == on.version:
            self._take_up(on.posed(), written.matrix)
        else:
            self._take_up(self._pose_of(written, surface, depsgraph), written.matrix)

    def _take_up(self, posed: PosedSurface, matrix: np.ndarray) -> None:
        assert self._edited is not None
        self._thing.take_up(self._ob.data, self._edited, posed, matrix)

    def _pose_of(
        self,
        written: live_attributes.Written,
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
    ) -> PosedSurface:
        """Returns the pose that fits the points which were not edited."""
        best, least = None, np.inf
        for pose, is_sure in self._poses(written, surface, depsgraph):
            misfit = self._misfit(pose, written.matrix)
            if misfit <= _ROUNDING or (is_sure and np.isnan(misfit)):
                return pose
            if is_sure and misfit < least:
                best, least = pose, misfit
        if best is None:
            raise RefusalError(
                f"{self._ob.name} was edited in frame {written.frame:g}, and {surface.name} has "
                "moved since then: go to that frame, because only there the edit can be applied"
            )
        return best

    def _poses(
        self,
        written: live_attributes.Written,
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
    ) -> Iterator[tuple[PosedSurface, bool]]:
        """Yields poses in which the points may have been written, and whether each of them would
        be believed without further evidence.
        """
        on, earlier = self._on, self._thing.surface_pose
        if earlier is not None and earlier.frame == written.frame and on.had(earlier):
            yield on.posed(earlier), True
        is_same_frame = on.pose.frame == written.frame
        if not is_same_frame and self._is_of_frame(written.frame):
            yield surface_at(surface, depsgraph, written.frame), True
        yield on.posed(), is_same_frame

    def _is_of_frame(self, frame: float) -> bool:
        """Tells whether all that follows live and deforms the surface is still as in this frame."""
        others = [live_attributes.written(data) for data in self._needed()]
        return all(other is None or other.frame == frame for other in others)

    def _misfit(self, posed: PosedSurface, matrix: np.ndarray) -> float:
        assert self._edited is not None
        return self._thing.misfit(self._ob.data, self._edited, posed, matrix)
