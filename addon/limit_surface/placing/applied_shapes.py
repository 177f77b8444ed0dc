# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that have lost their modifier of following because it was applied: their points are those
of one frame, but their places at rest are still those of the shape that was bound.
"""

from __future__ import annotations

import numpy as np

from .. import ids
from ..tasks.piecewise_job import Pieces, aside
from .posed_surface import SAME, PosedSurface, transformed
from .relocation import Elements

# Points must be so much nearer to the roots of this frame than to those at rest. Things beside the
# surface are at the same distance from both where the surface has hardly moved.
_NEARER = 0.5


def rows_as_posed(elements: Elements, posed: PosedSurface) -> Pieces:
    """Returns the elements that have a place, if their points are those that the surface gives them
    in this frame, and not those at rest; none otherwise. Their faces must be those of the surface.
    """
    places, matrix = elements.places, elements.matrix
    found = yield from aside(lambda _progress: posed.places(places.face, places.uv, matrix))
    here, at_rest = (
        transformed(matrix, roots.astype(np.float64))
        for roots in (found.position, elements.read(ids.REST_ROOT)[places.rows])
    )
    points = elements.first_points()[places.rows]
    moved = _distances(here, at_rest) > SAME * np.abs(points).max(initial=0)
    from_here, from_rest = (_distances(points, roots)[moved].sum() for roots in (here, at_rest))
    return places.rows if from_here < _NEARER * from_rest else places.rows[:0]


def _distances(some: np.ndarray, others: np.ndarray) -> np.ndarray:
    return np.linalg.norm(some - others, axis=1)
