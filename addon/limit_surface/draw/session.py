# SPDX-License-Identifier: GPL-3.0-or-later
"""The strokes while somebody draws, erases and smooths. It knows no window, and nothing is written
into the file.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from . import brush
from .ground import Ground
from .stroke import Stroke

#: As shares of the reach of an end: how near the end of a stroke comes to its beginning, and how
#: long it is at least, if it is to be closed.
CLOSES_WITHIN, LEAST_LENGTH = 1.0, 4.0


@dataclass
class Settings:
    tolerance: float  # world units
    steadying: int = 8  # iterations
    is_mirrored: bool = False
    continues: bool = True


@dataclass
class Samples:
    """The stroke under the pen: locations and pressures, in parts between which it left the
    surface.
    """

    reach: float  # world units: how near to an end counts as that end
    parts: list[list[tuple[int, np.ndarray, float, np.ndarray]]] = field(default_factory=list)
    is_interrupted: bool = True

    def add(self, face: int, uv: np.ndarray, pressure: float, position: np.ndarray) -> None:
        if self.is_interrupted:
            self.parts.append([])
            self.is_interrupted = False
        part = self.parts[-1]
        if part and np.array_equal(part[-1][3], position):
            return
        part.append((face, uv, pressure, position))

    def interrupt(self) -> None:
        self.is_interrupted = True

    def stand_on(self, ground: Ground) -> None:
        """Moves what was drawn to the same locations in another pose of the surface."""
        for part in self.parts:
            face, uv = [face for face, *_rest in part], [uv for _face, uv, *_rest in part]
            positions = ground.surface.evaluate(face, np.array(uv)).position
            part[:] = [
                (face, uv, pressure, position)
                for (face, uv, pressure, _before), position in zip(part, positions, strict=True)
            ]

    def positions(self) -> list[np.ndarray]:
        return [np.array([sample[3] for sample in part]) for part in self.parts if len(part) > 1]

    def strokes(self, ground: Ground) -> list[Stroke]:
        return [
            ground.stroke(
                np.array([face for face, *_rest in part], np.int32),
                np.array([uv for _face, uv, *_rest in part]),
                np.array([pressure for _face, _uv, pressure, _position in part]),
            )
            for part in self.parts
            if len(part) > 1
        ]


class Session:
    """Changes of the strokes, each of which can be taken back."""

    def __init__(self, ground: Ground, settings: Settings, strokes: list[Stroke]) -> None:
        self.ground, self.settings = ground, settings
        self.strokes = list(strokes)
        self.version = 0  # grows with every change
        self.lacks_mirror = False  # whether the last change had no mirror image, or not all of it
        self._original = list(strokes)
        self._undo: list[list[Stroke]] = []
        self._redo: list[list[Stroke]] = []
        self._before: list[Stroke] | None = None

    @property
    def is_changed(self) -> bool:
        return bool(self.changed or self.removed)

    @property
    def changed(self) -> list[Stroke]:
        """The strokes that no spline holds, or whose spline is removed."""
        removed = set(self.removed)
        return [stroke for stroke in self.strokes if stroke.spline < 0 or stroke.spline in removed]

    @property
    def removed(self) -> list[int]:
        """The splines whose strokes have gone or changed, all of them or some."""
        kept = {id(stroke) for stroke in self.strokes}
        return sorted({stroke.spline for stroke in self._original if id(stroke) not in kept})

    def stand_on(self, ground: Ground) -> None:
        """Goes on with another pose of the surface: all strokes, those that were taken back among
        them, stay at their locations.
        """
        self.ground = ground
        moved: dict[Stroke, Stroke] = {}

        def there(strokes: list[Stroke]) -> list[Stroke]:
            for stroke in strokes:
                if stroke not in moved:  # the same stroke stays the same in all lists
                    moved[stroke] = ground.again(stroke)
            return [moved[stroke] for stroke in strokes]

        self.strokes, self._original = there(self.strokes), there(self._original)
        self._undo = [there(strokes) for strokes in self._undo]
        self._redo = [there(strokes) for strokes in self._redo]
        if self._before is not None:
            self._before = there(self._before)
        self.version += 1

    def begin(self) -> None:
        """Begins a change that is taken back as a whole."""
        self._before = list(self.strokes)
        self.lacks_mirror = False

    def end(self) -> None:
        before, self._before = self._before, None
        if before is not None and not _are_same(before, self.strokes):
            self._undo.append(before)
            self._redo.clear()

    def drop(self) -> None:
        """Takes back the change that has begun."""
        if self._before is not None:
            self.strokes, self._before = self._before, None
            self.version += 1

    def undo(self) -> bool:
        return self._step(self._undo, self._redo)

    def redo(self) -> bool:
        return self._step(self._redo, self._undo)

    def _step(self, back: list[list[Stroke]], forth: list[list[Stroke]]) -> bool:
        if not back:
            return False
        forth.append(self.strokes)
        self.strokes = back.pop()
        self.version += 1
        return True

    def end_near(self, position: np.ndarray, reach: float) -> brush.End | None:
        if not self.settings.continues:
            return None
        return brush.nearest_end(self.strokes, position, reach)

    def draw(self, samples: Samples) -> None:
        """Adds what was drawn, and its mirror image."""
        for new in samples.strokes(self.ground):
            mirrored = self._mirrored(new)
            self._add(new, samples.reach)
            for other in mirrored:
                self._add(other, samples.reach)

    def erase(self, centre: np.ndarray, radius: float) -> None:
        self._touch(brush.erased, centre, radius)

    def smooth(self, centre: np.ndarray, radius: float) -> None:
        self._touch(brush.smoothed, centre, radius)

    def _mirrored(self, stroke: Stroke) -> list[Stroke]:
        """Returns the mirror image of a stroke, as far as the surface is there."""
        if not self.settings.is_mirrored:
            return []
        laid, is_whole = self.ground.mirror_image(stroke, self.settings.tolerance)
        self.lacks_mirror |= not is_whole
        return laid

    def _add(self, new: Stroke, reach: float) -> None:
        """Steadies a stroke and adds it, at the end of another one where it begins there."""
        new = brush.steadied(new, self.settings.steadying, self.ground)
        end = self.end_near(new.position[0], reach)
        if end:
            begun = self.strokes.pop(end.stroke)
            new = brush.continued(begun, end.is_last, new)
        laid = self.ground.laid_again(new, self.settings.tolerance)
        if len(laid) == 1:
            laid = self._closed(laid[0], reach)
        self.strokes += laid
        self.version += 1

    def _closed(self, stroke: Stroke, reach: float) -> list[Stroke]:
        """Closes a stroke that ends where it began."""
        length = np.linalg.norm(np.diff(stroke.position, axis=0), axis=1).sum()
        apart = np.linalg.norm(stroke.position[-1] - stroke.position[0])
        if (
            not self.settings.continues
            or apart > CLOSES_WITHIN * reach
            or length < LEAST_LENGTH * reach
            or len(stroke) < 4
        ):
            return [stroke]
        tolerance = self.settings.tolerance
        laid = self.ground.lay(stroke.position, stroke.radius, tolerance, is_closed=True)
        return laid if len(laid) == 1 else [stroke]

    def _touch(
        self,
        change: Callable[[Stroke, np.ndarray, float, Ground, float], list[Stroke]],
        centre: np.ndarray,
        radius: float,
    ) -> None:
        centres = [centre]
        if self.settings.is_mirrored:
            places, is_there = self.ground.mirror_places(centre[None])
            self.lacks_mirror |= not is_there.all()
            centres += list(places[is_there])
        for at in centres:
            after = [
                piece
                for stroke in self.strokes
                for piece in change(stroke, at, radius, self.ground, self.settings.tolerance)
            ]
            if not _are_same(self.strokes, after):
                self.strokes = after
                self.version += 1


def _are_same(before: list[Stroke], after: list[Stroke]) -> bool:
    return len(before) == len(after) and all(
        one is other for one, other in zip(before, after, strict=True)
    )
