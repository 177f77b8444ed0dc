# SPDX-License-Identifier: GPL-3.0-or-later
"""What the brushes do to strokes around a place."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .ground import Ground
from .stroke import Stroke

# Points are at most so far apart, as a share of the brush's radius, before it changes them.
STEP = 0.4
SMOOTHING = 4  # iterations at each touch of the brush


class End(NamedTuple):
    """An end of an open stroke, at which it can be continued."""

    stroke: int  # its place in the list of strokes
    is_last: bool  # whether it is the stroke's end, not its beginning
    position: np.ndarray


def _distances(stroke: Stroke, centre: np.ndarray) -> np.ndarray:
    return np.linalg.norm(stroke.position - centre, axis=1)


def _is_reached(stroke: Stroke, centre: np.ndarray, radius: float) -> bool:
    """Tells whether any of the stroke's segments comes within the radius."""
    a, b = stroke.position[:-1], stroke.position[1:]
    along = b - a
    squared = np.maximum(np.einsum("ij,ij->i", along, along), np.finfo(float).tiny)
    t = np.clip(np.einsum("ij,ij->i", centre - a, along) / squared, 0, 1)
    return bool((np.linalg.norm(a + t[:, None] * along - centre, axis=1) < radius).any())


def _dense(
    stroke: Stroke, centre: np.ndarray, radius: float, ground: Ground, tolerance: float
) -> list[Stroke]:
    """Returns the stroke with points that the brush can tell apart."""
    steps = np.linalg.norm(np.diff(stroke.position, axis=0), axis=1)
    if steps.max(initial=0) <= STEP * radius:
        return [stroke]
    return ground.laid_again(stroke, tolerance, STEP * radius)


def erased(
    stroke: Stroke, centre: np.ndarray, radius: float, ground: Ground, tolerance: float
) -> list[Stroke]:
    """Returns what is left of a stroke; itself where the brush does not reach it."""
    if not _is_reached(stroke, centre, radius):
        return [stroke]
    return [
        piece
        for dense in _dense(stroke, centre, radius, ground, tolerance)
        for piece in dense.pieces(_distances(dense, centre) >= radius)
    ]


def smoothed(
    stroke: Stroke, centre: np.ndarray, radius: float, ground: Ground, tolerance: float
) -> list[Stroke]:
    """Returns the stroke, smoothed most in the middle of the brush and not at all at its rim."""
    if not _is_reached(stroke, centre, radius):
        return [stroke]
    return [
        _smoothed(dense, np.clip(1 - _distances(dense, centre) / radius, 0, 1), SMOOTHING, ground)
        for dense in _dense(stroke, centre, radius, ground, tolerance)
    ]


def _smoothed(stroke: Stroke, weights: np.ndarray, iterations: int, ground: Ground) -> Stroke:
    found = ground.surface.smooth_path(
        stroke.face, stroke.uv, weights, iterations, closed=stroke.is_closed
    )
    return ground.stroke(found.face, found.uv, stroke.radius, stroke.is_closed)


def steadied(stroke: Stroke, iterations: int, ground: Ground) -> Stroke:
    """Returns the stroke without the trembling of the hand and the steps of the pixels."""
    return _smoothed(stroke, np.ones(len(stroke)), iterations, ground) if iterations else stroke


def nearest_end(strokes: list[Stroke], position: np.ndarray, reach: float) -> End | None:
    """Returns the nearest end of an open stroke within reach."""
    ends = [
        End(i, row == -1, stroke.position[row])
        for i, stroke in enumerate(strokes)
        if not stroke.is_closed
        for row in (0, -1)
    ]
    near = [(float(np.linalg.norm(end.position - position)), end) for end in ends]
    best = min(near, key=lambda pair: pair[0], default=None)
    return best[1] if best and best[0] <= reach else None


def continued(before: Stroke, is_last: bool, after: Stroke) -> Stroke:
    """Returns both strokes as one. The second begins where the first is to be continued; the path
    between them is still to be laid.
    """
    rows = np.arange(len(before))
    begun = before.rows(rows if is_last else rows[::-1])

    def joined(name: str) -> np.ndarray:
        return np.concatenate([getattr(begun, name), getattr(after, name)])

    face, uv, radius = joined("face"), joined("uv"), joined("radius")
    return Stroke(face, uv, radius, joined("position"), joined("normal"))
