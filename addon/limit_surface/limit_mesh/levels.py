# SPDX-License-Identifier: GPL-3.0-or-later
"""The level to which each face of a cage is divided."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..counting import counted
from ..errors import RefusalError
from ..reading import attributes, cage, camera, element_numbers, ragged_rows
from ..tasks.job import Progress

if TYPE_CHECKING:
    import limitsurf

MOST = 8

# what one face, and several, do that fall short
_TOO_FAR = "deviates by more than the tolerance", "deviate by more than the tolerance"
_TOO_LONG = "has edges that are too long", "have edges that are too long"

#: A function from the surface as it lies in the world to levels (f,) and warnings about them
Choice = Callable[["limitsurf.LimitSurface", Progress], tuple[np.ndarray, str]]


def uniform(levels: int) -> Choice:
    return lambda surface, _progress: (_allowed(surface, np.full(_count(surface), levels)), "")


def of_faces(values: np.ndarray) -> Choice:
    return lambda surface, _progress: (_allowed(surface, values), "")


def within(tolerance: float, most: int) -> Choice:
    def choose(surface: limitsurf.LimitSurface, progress: Progress) -> tuple[np.ndarray, str]:
        found = surface.levels_within(tolerance, most, progress=progress)
        return found.levels, _falling_short(found, tolerance, most, _TOO_FAR)

    return choose


def of_pixels(view: PixelView, pixels: float, most: int) -> Choice:
    def choose(surface: limitsurf.LimitSurface, progress: Progress) -> tuple[np.ndarray, str]:
        found = surface.levels_of_length(pixels, view.matrix, view.nearest, most, progress=progress)
        return found.levels, _falling_short(found, pixels, most, _TOO_LONG)

    return choose


@dataclass(frozen=True)
class PixelView:
    """The matrix from the world to pixels of the render, in homogeneous coordinates."""

    matrix: np.ndarray  # (4, 4)
    nearest: float  # w of the nearest visible points


def seen_by_camera(context: bpy.types.Context) -> PixelView:
    """Raises RefusalError where the scene has no camera that can be used."""
    ob, render = camera.find(context, ""), context.scene.render
    part = render.resolution_percentage / 100
    size = (render.resolution_x * part, render.resolution_y * part)
    depsgraph = context.evaluated_depsgraph_get()
    rounded = tuple(max(round(side), 1) for side in size)
    projector = camera.projector(ob, depsgraph, rounded)
    to_pixels = np.diag([size[0] / 2, size[1] / 2, 1.0, 1.0])
    nearest = ob.evaluated_get(depsgraph).data.clip_start if projector.has_eye else 0.0
    return PixelView(to_pixels @ projector.matrix, nearest)


def named(
    name: str,
    levels: int,
    mesh: bpy.types.Mesh,
    found: cage.Cage,
    ob: bpy.types.Object,
    weights: Mapping[str, np.ndarray],
) -> Choice:
    """Returns the levels that an attribute of faces, or a vertex group, of that name gives. Weights
    of a group are parts of `levels`, and each face takes the largest weight of its vertices.
    """
    if name in mesh.attributes or name not in weights:
        return of_faces(_whole_levels(mesh, name, ob))
    if not weights[name].any():
        raise RefusalError(f"The vertex group {name} of {ob.name} has no weights")
    starts = ragged_rows.starts(found.face_sizes)
    largest = np.maximum.reduceat(weights[name][found.mesh.face_vertices], starts)
    return of_faces(np.rint(largest * levels).astype(np.int64))


def _whole_levels(mesh: bpy.types.Mesh, name: str, ob: bpy.types.Object) -> np.ndarray:
    attribute = mesh.attributes.get(name)
    if attribute is None:
        raise RefusalError(
            f"{ob.name} has neither a face attribute nor a vertex group named {name!r}"
        )
    if attribute.domain != "FACE" or attribute.data_type not in element_numbers.TYPES:
        raise RefusalError(
            f"The attribute {name} is {attribute.data_type} on {attribute.domain}: choose an "
            "attribute of faces (FACE) that holds numbers"
        )
    values = attributes.read(mesh, name).astype(np.float64)
    wrong = np.flatnonzero(~((values > -0.5) & (values < MOST + 0.5)))
    if wrong.size:
        raise RefusalError(
            f"The attribute {name} is {values[wrong[0]]:g} on face {wrong[0]} "
            f"({wrong.size} in all): levels are 0 to {MOST}"
        )
    return np.rint(values).astype(np.int64)


def _allowed(surface: limitsurf.LimitSurface, levels: np.ndarray) -> np.ndarray:
    """Returns the levels with at least 1 on faces other than quads, which are divided once at
    least.
    """
    return np.maximum(levels, surface.mesh.face_sizes != 4)


def _count(surface: limitsurf.LimitSurface) -> int:
    return len(surface.mesh.face_sizes)


def _falling_short(
    found: limitsurf.FaceLevels, asked: float, most: int, what: tuple[str, str]
) -> str:
    count = np.count_nonzero(found.measure > asked)
    if not count:
        return ""
    short = f"{counted(count, 'faces', *what)} at level {most}"
    return f"{short}, the highest one" if most == MOST else f"{short}: raise Most Levels"
