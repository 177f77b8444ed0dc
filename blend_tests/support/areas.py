# SPDX-License-Identifier: GPL-3.0-or-later
"""Areas and weights of faces, summed over fine polygons, to compare scattered locations with."""

from collections.abc import Callable

import bpy
import numpy as np
import scenes

STEPS = 24  # polygons along each side of a Ptex face


def grid(face_count: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns the middles of STEPS x STEPS cells on each face."""
    at = (np.arange(STEPS) + 0.5) / STEPS
    u, v = (x.ravel() for x in np.meshgrid(at, at))
    face = np.repeat(np.arange(face_count), STEPS**2)
    return face, np.tile(np.stack([u, v], axis=1), (face_count, 1))


def cell_areas(ob: bpy.types.Object, boundary: str = "ALL") -> np.ndarray:
    """Returns the areas of the cells of `grid` in the world, each as two triangles with corners on
    the surface.
    """
    surface = scenes.surface_without_addon(ob, boundary)
    at = np.arange(STEPS + 1) / STEPS
    v, u = (x.ravel() for x in np.meshgrid(at, at, indexing="ij"))
    face = np.repeat(np.arange(surface.face_count), len(u))
    uv = np.tile(np.stack([u, v], axis=1), (surface.face_count, 1))
    place = scenes.transformed(ob.matrix_world, surface.evaluate(face, uv).position)
    p = place.reshape(surface.face_count, STEPS + 1, STEPS + 1, 3)
    a, b, c, d = p[:, :-1, :-1], p[:, :-1, 1:], p[:, 1:, 1:], p[:, 1:, :-1]
    triangles = np.cross(b - a, c - a), np.cross(c - a, d - a)
    return sum(np.linalg.norm(t, axis=-1) for t in triangles).ravel() / 2


def expected_parts(
    ob: bpy.types.Object, density: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None
) -> np.ndarray:
    """Returns the share of all locations that each face should get."""
    areas = cell_areas(ob)
    if density:
        areas = areas * density(*grid(len(areas) // STEPS**2))
    per_face = areas.reshape(-1, STEPS**2).sum(axis=1)
    return per_face / per_face.sum()


def check_parts(face: np.ndarray, parts: np.ndarray) -> None:
    """Applies the chi-square test, whose sum has the mean `freedom` and twice that as its
    variance.
    """
    counts = np.bincount(face, minlength=len(parts))
    assert not counts[parts == 0].any()
    expected = len(face) * parts[parts > 0]
    chi_square = ((counts[parts > 0] - expected) ** 2 / expected).sum()
    freedom = len(expected) - 1
    assert chi_square < freedom + 4.5 * np.sqrt(2 * freedom) + 4, (chi_square, freedom)
