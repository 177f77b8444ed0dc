# SPDX-License-Identifier: GPL-3.0-or-later
"""A cage's UV map at locations of the limit surface."""

import numpy as np


class PtexMap:
    """Values at face corners, bilinear on each Ptex face between its four corners.

    A quad's are its own. The sub-face at corner i of any other polygon has that corner, the
    midpoint of the edge that leaves it, the polygon's centre, the midpoint of the edge before it.
    """

    def __init__(
        self,
        face_sizes: np.ndarray,
        values: np.ndarray,  # one row per face corner
        base_face: np.ndarray,  # of each Ptex face, as LimitSurface tells it
        corner: np.ndarray,
    ) -> None:
        starts = np.concatenate([[0], np.cumsum(face_sizes)[:-1]])
        size, start = face_sizes[base_face], starts[base_face]
        here, after, opposite, before = (
            values[start + (corner + step) % size] for step in (0, 1, 2, -1)
        )
        split = (size != 4)[:, None]
        centre = np.add.reduceat(values, starts)[base_face] / size[:, None]
        self._here = here
        self._after = np.where(split, (here + after) / 2, after)
        self._opposite = np.where(split, centre, opposite)
        self._before = np.where(split, (here + before) / 2, before)

    def at(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        u, v = uv[:, :1], uv[:, 1:]
        value = (1 - u) * (1 - v) * self._here[face]
        value += u * (1 - v) * self._after[face]
        value += u * v * self._opposite[face]
        value += (1 - u) * v * self._before[face]
        return value
