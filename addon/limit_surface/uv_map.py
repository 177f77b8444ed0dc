# SPDX-License-Identifier: GPL-3.0-or-later
"""A cage's UV map at locations of the limit surface."""

import numpy as np


class PtexCorners:
    """The four corners of each Ptex face, in the order of its (u, v): 00, 10, 11, 01.

    A quad's are its own. The sub-face at corner i of any other polygon has that corner, the
    midpoint of the edge that leaves it, the polygon's centre, the midpoint of the edge before it.
    """

    def __init__(self, face_sizes: np.ndarray, values: np.ndarray) -> None:
        """`values`: one row per face corner."""
        self._sizes = face_sizes
        self._starts = np.concatenate([[0], np.cumsum(face_sizes)[:-1]])
        self._values = values

    def at(self, base_face: np.ndarray, corner: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Bilinear on Ptex faces, each given as base face and corner (0 for quads)."""
        size, start = self._sizes[base_face], self._starts[base_face]
        here, after, opposite, before = (
            self._values[start + (corner + step) % size] for step in (0, 1, 2, -1)
        )
        split = (size != 4)[:, None]
        centre = np.add.reduceat(self._values, self._starts)[base_face] / size[:, None]
        after = np.where(split, (here + after) / 2, after)
        opposite = np.where(split, centre, opposite)
        before = np.where(split, (here + before) / 2, before)
        u, v = uv[:, :1], uv[:, 1:]
        return (here * (1 - u) + after * u) * (1 - v) + (before * (1 - u) + opposite * u) * v
