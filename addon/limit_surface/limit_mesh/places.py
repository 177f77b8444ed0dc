# SPDX-License-Identifier: GPL-3.0-or-later
"""Which elements of the cage the elements of its tessellation lie on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..reading import ragged_rows

if TYPE_CHECKING:
    import limitsurf

#: A quad's corner by whether u and whether v is in the upper half
_QUAD_CORNER = np.array([[0, 3], [1, 2]])


class CageElements:
    """Corners of the cage's faces, counted over all of them."""

    def __init__(self, surface: limitsurf.LimitSurface) -> None:
        sizes = surface.mesh.face_sizes.astype(np.int64)
        self._size = sizes[surface.base_face]
        self._start = ragged_rows.starts(sizes)[surface.base_face]
        self._corner = surface.corner

    def nearest_corner(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Of places on Ptex faces: of a quad's corners the one nearest in (u, v), of any other
        face's the one whose part it is."""
        upper = (uv > 0.5).astype(np.int8)
        of_quad = _QUAD_CORNER[upper[:, 0], upper[:, 1]]
        is_quad = self._size[face] == 4
        return self._start[face] + np.where(is_quad, of_quad, self._corner[face])

    def corner_of_side(self, face: np.ndarray, uv: np.ndarray, to: np.ndarray) -> np.ndarray:
        """Of straight lines on Ptex faces, from `uv` to `to`: the corner from which the cage's edge
        leaves that they are part of; -1 for those within a face."""
        low, high = ((uv == end) & (to == end) for end in (0, 1))
        is_quad = self._size[face] == 4
        corner = np.full(len(face), -1)
        own, size = self._corner[face], self._size[face]
        corner = np.where(low[:, 1], np.where(is_quad, 0, own), corner)
        corner = np.where(low[:, 0], np.where(is_quad, 3, (own - 1) % size), corner)
        corner = np.where(is_quad & high[:, 0], 1, corner)
        corner = np.where(is_quad & high[:, 1], 2, corner)
        return np.where(corner >= 0, self._start[face] + corner, -1)
