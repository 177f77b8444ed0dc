# SPDX-License-Identifier: GPL-3.0-or-later
"""Empties as projectors: a flat image that is projected along -Z, or one on each side of a box."""

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import present_object
from ..reading.projector import Projector, fitted, inverse

# the share of the surface's extent, or of its distance, that is added before and behind it, where
# no depths are given
ROOM = 0.01


def find(name: str) -> bpy.types.Object:
    ob = bpy.data.objects.get(name)
    if ob is None or ob.type != "EMPTY":
        raise RefusalError(f"There is no empty {name!r}" if name else "No empty is chosen")
    return ob


def planar(
    ob: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    size: tuple[float, float],
    bounds: np.ndarray,
    depth: tuple[float, float] | None = None,
) -> Projector:
    """Returns the projector of the rectangle in which an image empty shows its image. For another
    empty it is the square of the empty's size, or the largest part of it with the image's
    proportions. `depth` gives two distances behind the empty in the world; without it the projector
    reaches all of the surface, whose bounds (2, 3) are given in the world.
    """
    called, matrix = f"The empty {ob.name}", _world_matrix(ob, depsgraph)
    middle, half = _rectangle(ob, size)
    placed = matrix @ _frame(np.diag([*half, 1]), np.array([*middle, 0]))
    return Projector(called, _flat(placed, called, bounds, depth), has_eye=False)


def to_box(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray:
    """Returns the matrix from the world to the coordinates in which the empty's cube reaches from
    -1 to 1.
    """
    cube = _frame(np.diag([ob.empty_display_size] * 3), np.zeros(3))
    return inverse(_world_matrix(ob, depsgraph) @ cube, f"The empty {ob.name}")


def _world_matrix(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray:
    with present_object.evaluated(ob, depsgraph) as evaluated:
        return np.array(evaluated.matrix_world, np.float64)


def _rectangle(ob: bpy.types.Object, size: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Returns the middle and the half sides in the empty's x-y plane."""
    if ob.empty_display_type != "IMAGE":
        return np.zeros(2), ob.empty_display_size * fitted(size)
    sides = ob.empty_display_size * fitted(_shown_size(ob.data) if ob.data else (1, 1))
    return (np.array(ob.empty_image_offset) + 0.5) * sides, sides / 2


def _shown_size(image: bpy.types.Image) -> tuple[float, float]:
    width, height = (np.array(image.size) * image.display_aspect).tolist()
    return (width, height) if width and height else (1, 1)


def _frame(axes: np.ndarray, origin: np.ndarray) -> np.ndarray:
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = axes, origin
    return frame


def _flat(
    placed: np.ndarray, called: str, bounds: np.ndarray, depth: tuple[float, float] | None
) -> np.ndarray:
    """Returns the matrix from the world to the square [-1, 1]^2 of a frame's x-y plane, seen from
    its +Z.
    """
    matrix = inverse(placed, called)
    if depth is None:
        corners = np.stack(np.meshgrid(*bounds.T, indexing="ij"), axis=-1).reshape(-1, 3)
        behind = -(corners @ matrix[2, :3] + matrix[2, 3])
        # A flat surface may lie in the empty's own plane, so its extent along the rays and its
        # distance may both be 0.
        extent = np.linalg.norm(np.ptp(bounds, axis=0)) * np.linalg.norm(matrix[2, :3])
        room = ROOM * max(extent, np.abs(behind).max())
        near, far = behind.min() - room, behind.max() + room
    else:
        near, far = np.array(depth) / np.linalg.norm(placed[:3, 2])
        if not near < far:
            raise RefusalError(
                f"There is no space between the depths {depth[0]:g} and {depth[1]:g}"
            )
    z = np.array([0, 0, -2 / (far - near), -(far + near) / (far - near)])
    return np.array([*(np.eye(4)[:2]), z, np.eye(4)[3]]) @ matrix
