# SPDX-License-Identifier: GPL-3.0-or-later
"""The transforms of objects, as matrices that can be computed with."""

from __future__ import annotations

import bpy
import numpy as np

from ..errors import RefusalError

SINGULAR = 1e-12  # as a share of the largest singular value


def world_matrix(ob: bpy.types.Object) -> np.ndarray:
    """Returns the matrix (4, 4) from the object to the world. Raises RefusalError where it has no
    inverse.
    """
    matrix = np.array(ob.matrix_world, np.float64)
    check_invertible(matrix, ob.name)
    return matrix


def relation(space: np.ndarray, matrix: np.ndarray, called: str) -> np.ndarray:
    """Returns the matrix to an object's space, whose name is for messages, from that of another
    object. Raises RefusalError where there is none.
    """
    check_invertible(space, called)
    return np.linalg.solve(space, matrix)


def check_finite(matrix: np.ndarray, called: str) -> None:
    """Raises RefusalError for the transform of an object, by its name in messages, that holds
    infinite numbers or none at all.
    """
    if not np.isfinite(matrix).all():
        raise RefusalError(
            f"{called} has a location, rotation or scale that is not a finite number"
        )


def check_invertible(matrix: np.ndarray, called: str) -> None:
    """Raises RefusalError for a transform that is not finite, or flattens the object."""
    check_finite(matrix, called)
    values = np.linalg.svd(matrix[:3, :3], compute_uv=False)
    if not values[-1] > SINGULAR * values[0]:
        raise RefusalError(f"{called} has a scale of 0 along an axis")
