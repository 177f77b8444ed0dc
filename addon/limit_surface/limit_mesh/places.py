# SPDX-License-Identifier: GPL-3.0-or-later
"""The elements of the cage on which the elements of its tessellation lie."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..reading import ragged_rows

if TYPE_CHECKING:
    import limitsurf

#: The corner of a quad, by whether u is in the upper half and whether v is
_QUAD_CORNER = np.array([[0, 3], [1, 2]])


class CageElements:
    """Finds corners of the cage's faces, numbered over all faces."""

    def __init__(self, surface: limitsurf.LimitSurface) -> None:
        sizes = surface.mesh.face_sizes.astype(np.int64)
        self._size = sizes[surface.base_face]
        self._start = ragged_rows.starts(sizes)[surface.base_face]
        self._corner = surface.corner

    def nearest_corner(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Returns the corners nearest to places on Ptex faces: for a quad the corner nearest in (u,
        v), for other faces the corner of the sub-face.
        """
        upper = (uv > 0.5).astype(np.int8)
        of_quad = _QUAD_CORNER[upper[:, 0], upper[:, 1]]
        is_quad = self._size[face] == 4
        return self._start[face] + np.where(is_quad, of_quad, self._corner[face])

    def corner_of_side(self, face: np.ndarray, uv: np.ndarray, to: np.ndarray) -> np.ndarray:
        """Returns, for straight lines on Ptex faces from `uv` to `to`, the corner at which the
        cage's edge begins that the line is part of; -1 for lines within a face.
        """
        low, high = ((uv == end) & (to == end) for end in (0, 1))
        is_quad = self._size[face] == 4
        corner = np.full(len(face), -1)
        own, size = self._corner[face], self._size[face]
        corner = np.where(low[:, 1], np.where(is_quad, 0, own), corner)
        corner = np.where(low[:, 0], np.where(is_quad, 3, (own - 1) % size), corner)
        corner = np.where(is_quad & high[:, 0], 1, corner)
        corner = np.where(is_quad & high[:, 1], 2, corner)
        return np.where(corner >= 0, self._start[face] + corner, -1)
