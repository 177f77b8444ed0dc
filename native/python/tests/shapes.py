# SPDX-License-Identifier: Apache-2.0
"""Control meshes for the tests, as (positions, faces)."""

import numpy as np


def row_bounds(sizes):
    """Where each of the rows begins that follow each other end to end, with so many elements each;
    last, where the whole ends.
    """
    return np.concatenate([[0], np.cumsum(sizes)])


def grid(columns: int, rows: int):
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0))
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    return positions, grid_faces(columns, rows)


def grid_faces(columns: int, rows: int):
    """Of a grid whose vertices are numbered row by row."""
    first = (np.arange(columns) + (columns + 1) * np.arange(rows)[:, None]).ravel()
    return first[:, None] + [0, 1, columns + 2, columns + 1]


def halves(quads):
    """Two triangles for each quad."""
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def cube():
    positions = np.array([[i % 2, i // 2 % 2, i // 4] for i in range(8)], float)
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return positions, np.array(faces)


def house():
    """A cube with a roof: quads, triangles, a pentagon each way, open at the bottom."""
    positions = np.array(
        [
            [0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0],
            [0, 0, 1], [2, 0, 1], [2, 1, 1], [0, 1, 1],
            [0, 0.5, 1.6], [2, 0.5, 1.6], [3, 0.5, 0.4],
        ],
        float,
    )  # fmt: skip
    faces = [
        [0, 1, 5, 4], [2, 3, 7, 6], [0, 4, 8, 7, 3], [4, 5, 9, 8], [8, 9, 6, 7],
        [1, 10, 5], [10, 2, 6], [5, 10, 6, 9],
    ]  # fmt: skip
    return positions, faces


def fan(count: int, closed: bool, seed: int = 1):
    """Quads around vertex 0, which is an interior or a boundary one; irregular at (0, 0) of all."""
    rng = np.random.default_rng(seed)
    turn = 2 * np.pi if closed else min(1.7 * np.pi, 0.5 * np.pi * count)
    spokes = count if closed else count + 1
    at = turn * np.arange(spokes) / count
    between = turn * (np.arange(count) + 0.5) / count
    positions = np.zeros((1 + spokes + count, 3))
    positions[1 : 1 + spokes, :2] = np.stack([np.cos(at), np.sin(at)], axis=1)
    positions[1 + spokes :, :2] = 1.4 * np.stack([np.cos(between), np.sin(between)], axis=1)
    positions += rng.uniform(-0.1, 0.1, positions.shape)
    faces = [[0, 1 + i, 1 + spokes + i, 1 + (i + 1) % spokes] for i in range(count)]
    return positions, np.array(faces)


def pole(count: int):
    """A disc of triangles around vertex 0."""
    angle = 2 * np.pi * np.arange(count) / count
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
    around = np.arange(count)
    faces = np.stack([np.zeros(count, int), around + 1, (around + 1) % count + 1], axis=1)
    return np.concatenate([[[0, 0, 0.5]], rim]), faces


ALL = {
    "grid": grid(4, 3),
    "cube": cube(),
    "house": house(),
    "interior fan": fan(5, True),
    "boundary fan": fan(5, False),
    "corner": fan(1, False),
}
