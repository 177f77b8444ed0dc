# SPDX-License-Identifier: Apache-2.0
"""Sheets, fans and blocks of cubes, with their heights."""

from collections.abc import Callable, Sequence

import bpy
import numpy as np
from limit_surface.reading import attributes

from figures.meshes import grids

Faces = Sequence[Sequence[int]]
Height = Callable[[np.ndarray, np.ndarray], np.ndarray]


def hill(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A height that bends in both directions and has no symmetry."""
    return 0.45 * np.sin(0.9 * x + 0.3) * np.cos(0.8 * y - 0.2) - 0.06 * (x**2 + y**2)


def ridge(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return hill(x, y) - 0.6 * np.abs(x)


def plateau(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.6 * (np.maximum(np.abs(x), np.abs(y)) < 1) + 0.1 * np.sin(x + 2 * y)


def raised(flat: np.ndarray, height: Height = hill) -> np.ndarray:
    return np.column_stack([flat, height(*flat.T)])


def sheet(columns: int, rows: int, height: Height = hill) -> tuple[np.ndarray, Faces]:
    """A sheet of unit squares around the origin."""
    j, i = np.mgrid[: rows + 1, : columns + 1].reshape(2, -1)
    flat = np.stack([i - columns / 2, j - rows / 2], axis=1)
    return raised(flat, height), grids.grid_faces(columns, rows).tolist()


def fan(sectors: int, rings: int, angle: float, height: Height = hill) -> tuple[np.ndarray, Faces]:
    """Squares of rings x rings faces around a vertex, filling the angle."""
    made = grids.fan(sectors, rings, closed=angle == 2 * np.pi)
    turn = (made.sector + made.j / np.maximum(made.i + made.j, 1)) * (angle / sectors)
    reach = (made.i**8.0 + made.j**8.0) ** (1 / 8)
    flat = np.stack([reach * np.cos(turn), reach * np.sin(turn)], axis=1)
    return raised(flat, height), made.faces.tolist()


def cubes(middles: np.ndarray) -> tuple[np.ndarray, Faces]:
    """The outer faces of unit cubes on a grid."""
    square = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) / 2
    found = []
    for axis in range(3):
        for side in (-1, 1):
            free = ~np.isin(_keys(middles + side * np.eye(3)[axis]), _keys(middles))
            face = np.roll(np.column_stack([np.full(4, side / 2), square[::side]]), axis, axis=1)
            found.append(middles[free, None] + face)
    corners = np.concatenate(found)
    positions, faces = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return positions, faces.reshape(-1, 4).tolist()


def _keys(places: np.ndarray) -> np.ndarray:
    return np.rint(places) @ [1, 100, 10_000]


def taken() -> tuple[np.ndarray, Faces]:
    """Takes the mesh of the object that an operator has just added, and removes the object."""
    ob = bpy.context.active_object
    positions = attributes.read(ob.data, "position").astype(np.float64)
    faces = [polygon.vertices[:] for polygon in ob.data.polygons]
    bpy.data.objects.remove(ob)
    return positions, faces
