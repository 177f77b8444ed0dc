# SPDX-License-Identifier: Apache-2.0
"""A mesh for queries, and answers that use no search structure, for `bench_blender.py`."""

from typing import NamedTuple

import bpy
import limitsurf
import numpy as np
from figures.meshes import grids
from limit_surface.reading import subdivided_mesh
from mathutils.bvhtree import BVHTree

WIDTH = 1.0  # as a share of a face
SLOPE = 0.7  # at most this share of the mesh
REACH = 0.3  # how much farther than the nearest polygon the polygons of the right face can be


def add_sheet(side: int, seed: int = 0) -> bpy.types.Object:
    """Adds about side x side faces over a plane: wavy, open, with holes, and some of them cut into
    triangles.
    """
    y, x = np.mgrid[: side + 1, : side + 1].reshape(2, -1) * WIDTH
    z = 0.9 * np.sin(0.45 * x) * np.cos(0.35 * y) + 0.25 * np.sin(1.1 * (x + y))
    rng = np.random.default_rng(seed)
    rows, columns = np.mgrid[:side, :side].reshape(2, -1)
    quads = grids.grid_faces(side, side)
    kind = rng.random(len(quads))
    kept = quads[(kind > 0.03) | (rows % 3 != 1) | (columns % 3 != 1)]
    cut = rng.random(len(kept)) < 0.01
    triangles = np.concatenate([kept[cut][:, [0, 1, 2]], kept[cut][:, [0, 2, 3]]])
    faces = kept[~cut].tolist() + triangles.tolist()
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(np.stack([x, y, z], axis=1).tolist(), [], faces)
    ob = bpy.data.objects.new("Sheet", mesh)
    bpy.context.collection.objects.link(ob)
    ob.modifiers.new("Subdivision", "SUBSURF")
    return ob


class Rays(NamedTuple):
    origin: np.ndarray
    direction: np.ndarray
    hit: np.ndarray  # the only hit on the limit surface


def rays(surface: limitsurf.LimitSurface, count: int, seed: int = 0) -> Rays:
    """Returns rays from above towards random places, steeper than any slope of the surface: each of
    them meets it there and nowhere else.
    """
    rng = np.random.default_rng(seed)
    hit = surface.evaluate(
        rng.integers(0, surface.face_count, count), rng.random((count, 2))
    ).position
    turn, tilt = rng.uniform(0, 2 * np.pi, count), rng.uniform(0, 0.9, count) / SLOPE
    towards = np.stack([tilt * np.cos(turn), tilt * np.sin(turn), -np.ones(count)], axis=1)
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    return Rays(hit - rng.uniform(3, 8, (count, 1)) * towards, towards, hit)


def points_nearby(surface: limitsurf.LimitSurface, count: int, seed: int = 0) -> np.ndarray:
    """Returns points within 5 % of the diagonal."""
    rng = np.random.default_rng(seed)
    face, uv = rng.integers(0, surface.face_count, count), rng.random((count, 2))
    diagonal = np.linalg.norm(np.ptp(surface.positions, axis=0))
    away = rng.uniform(-0.05, 0.05, (count, 1)) * diagonal
    return surface.evaluate(face, uv).position + away * surface.frames(face, uv)[:, :, 2]


def nearest(
    surface: limitsurf.LimitSurface, face_sizes: np.ndarray, tree: BVHTree, points: np.ndarray
) -> np.ndarray:
    """Returns the nearest points of the limit surface by brute force: every face that could hold
    the nearest point, judged by its level 4 polygons in `tree`, is sampled ever more closely around
    its best sample.
    """
    polygon_face = subdivided_mesh.corner_locations(face_sizes, 4).face[::4]
    row, face = [], []
    for i, point in enumerate(points.tolist()):
        distance = tree.find_nearest(point)[3]
        near = [hit[2] for hit in tree.find_nearest_range(point, distance + REACH)]
        candidates = np.unique(polygon_face[near])
        row.append(np.full(len(candidates), i))
        face.append(candidates)
    row, face = np.concatenate(row), np.concatenate(face)
    found, distance = _nearest_on_faces(surface, face, points[row])
    order = np.lexsort((distance, row))
    best = order[np.unique(row[order], return_index=True)[1]]
    return found[best]


def _nearest_on_faces(
    surface: limitsurf.LimitSurface, face: np.ndarray, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns for each face the point nearest to its query, and the distance."""
    centre, width = np.full((len(face), 2), 0.5), 0.5
    while width > 1e-13:
        samples = 33 if width == 0.5 else 9
        along = np.linspace(-width, width, samples)
        grid = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
        uv = np.clip(centre[:, None] + grid, 0, 1)
        found = np.empty((len(face), 3))
        for i in np.array_split(np.arange(len(face)), max(len(face) * len(grid) // 500_000, 1)):
            position = surface.evaluate(
                np.repeat(face[i], len(grid)), uv[i].reshape(-1, 2)
            ).position.reshape(len(i), -1, 3)
            best = np.argmin(np.linalg.norm(position - points[i][:, None], axis=2), axis=1)
            centre[i] = uv[i, best]
            found[i] = position[np.arange(len(i)), best]
        # The neighbours of the best sample still lie inside.
        width *= 3 / (samples - 1)
    return found, np.linalg.norm(found - points, axis=1)
