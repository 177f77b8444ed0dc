# SPDX-License-Identifier: Apache-2.0
"""The table of docs/displacement.md: how closely a displacement map reproduces the sculpt."""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import bpy
import limitsurf as ls
import numpy as np
from limit_surface.reading import cage

from figures import tables
from figures.displacement import head as heads

SIZES = (256, 512, 1024, 2048, 4096)
SAMPLES = 200_000
MARGIN = 2  # texels: bilinear filtering reads one beyond the border
ROWS = 1 << 20  # texels at a time


class Case(NamedTuple):
    base: ls.LimitSurface
    target: ls.LimitSurface
    uv_map: ls.SurfaceData
    diagonal: float


class Errors(NamedTuple):
    """Distances from the sculpt, relative to the diagonal."""

    size: int
    inner: np.ndarray  # where all four texels that are read lie on the map
    border: np.ndarray  # at seams, where some of them belong to the margin


def head() -> Case:
    ob = heads.add_base()
    sculpt = heads.add_sculpt(ob)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found, other = cage.read(ob, depsgraph), cage.read(sculpt, depsgraph)
    base = ls.LimitSurface(found.mesh)
    uv_map = base.face_varying(
        found.uv_map.values, found.uv_map.indices, found.rules.uv_interpolation
    )
    diagonal = float(np.linalg.norm(np.ptp(found.mesh.positions, axis=0)))
    return Case(base, ls.LimitSurface(other.mesh), uv_map, diagonal)


def measure(case: Case, size: int, samples: int) -> Errors:
    base, target, uv_map, diagonal = case
    pixels, inside = baked(case, size)
    at = base.scatter_uniform(samples, 1)
    places = uv_map.evaluate(at.face, at.uv).value
    frames = base.tangent_frames(uv_map, at.face, at.uv)
    moved = base.displaced(at.face, at.uv, ls.bilinear(pixels, places), frames=frames)
    there = ls.SubdividedFaces(base.mesh, target.mesh).locate(at.face, at.uv)
    error = np.linalg.norm(moved - target.evaluate(there.face, there.uv).position, axis=1)
    x, y = np.clip(np.floor(places * size - 0.5).astype(int), 0, size - 2).T
    inner = inside[y, x] & inside[y, x + 1] & inside[y + 1, x] & inside[y + 1, x + 1]
    return Errors(size, error[inner] / diagonal, error[~inner] / diagonal)


def baked(case: Case, size: int) -> tuple[np.ndarray, np.ndarray]:
    """The map's pixels (size, size, 3), and whether each lies on the map and not on its margin."""
    base, target, uv_map, _ = case
    texels = uv_map.rasterize(size, size, margin=MARGIN)
    pixels = np.zeros((size, size, 3), np.float32)
    inside = np.zeros((size, size), bool)
    inside[texels.y, texels.x] = texels.inside
    for begin in range(0, len(texels.x), ROWS):
        rows = slice(begin, begin + ROWS)
        face, uv = texels.face[rows], texels.uv[rows]
        frames = base.tangent_frames(uv_map, face, uv)
        pixels[texels.y[rows], texels.x[rows]] = base.vector_displacement(
            target, face, uv, frames=frames
        )
    return pixels, inside


def numbers(errors: Errors) -> list[float]:
    """The largest error, the largest of 99 %, the root mean square, and the largest at seams."""
    inner = errors.inner
    root_mean_square = np.sqrt((inner**2).mean())
    return [inner.max(), np.quantile(inner, 0.99), root_mean_square, errors.border.max()]


def table(found: Iterable[Errors]) -> str:
    lines = [
        "| texels a side | largest | largest of 99 % | root mean square | largest at seams |",
        "|---|---|---|---|---|",
    ]
    for errors in found:
        cells = " | ".join(f"{value:.1e}" for value in numbers(errors))
        lines.append(f"| {errors.size} | {cells} |")
    return "\n".join(lines)


def make(folder: Path) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    case = head()
    found = [measure(case, size, SAMPLES) for size in SIZES]
    tables.write("displacement.md", {"errors": table(found)}, folder)
