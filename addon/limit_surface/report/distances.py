# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of a displayed mesh from the limit surface, in world units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..errors import RefusalError
from ..reading import cage, displayed_mesh
from ..tasks.job import Progress, part_of
from .places import Patches, patches

if TYPE_CHECKING:
    import limitsurf


@dataclass
class Statistics:
    """The largest and the mean of one distance over the displayed mesh."""

    largest: float = 0.0  # the largest at all places
    sum: float = 0.0  # the mean over the area
    area: float = 0.0

    @property
    def mean(self) -> float:
        return self.sum / self.area if self.area else 0.0

    def add(self, part: Patches, values: np.ndarray, areas: np.ndarray) -> None:
        self.largest = max(self.largest, float(values.max()))
        self.sum += part.sum(values, areas)
        self.area += float(areas.sum())


@dataclass
class Distances:
    level: int
    apart: Statistics  # distances from the nearest point of the limit surface
    slide: Statistics  # distances from the same location (face, u and v) of the limit surface
    at_vertices: np.ndarray  # (v,) the largest `apart` around each vertex of the cage


def measure_all(
    found: cage.Cage, meshes: Mapping[str, displayed_mesh.DisplayedMesh], progress: Progress
) -> tuple[dict[str, Distances], int]:
    """Returns the distances of each mesh, and the number of the cage's faces that have no limit
    surface. Blender's data is not touched.
    """
    surface = found.surface(in_world=True)
    if not np.ptp(surface.positions, axis=0).any():
        raise RefusalError(f"All points of {found.name} lie at one place")
    refused = len(surface.refused)
    if refused == len(found.face_sizes):
        raise RefusalError(f"No face has a limit surface: {next(iter(surface.refused.values()))}")
    results = {}
    for i, (name, shown) in enumerate(meshes.items()):
        here = part_of(progress, i / len(meshes), (i + 1) / len(meshes))
        results[name] = measure(surface, found, shown, here)
    return results, refused


def measure(
    surface: limitsurf.LimitSurface,
    found: cage.Cage,
    shown: displayed_mesh.DisplayedMesh,
    progress: Progress,
) -> Distances:
    """Measures all faces that have a limit surface; `surface` is that of the cage in the world."""
    groups = patches(found, shown, surface.refused)
    total = sum(group.count for group in groups)
    done = 0
    result = Distances(shown.level, Statistics(), Statistics(), np.zeros(len(found.mesh.positions)))
    for group in groups:
        for part in group.parts():
            face, uv = part.locations()
            positions = found.to_world(shown.positions(face, uv))
            areas = part.areas(positions)
            searching = part_of(progress, done / total, (done + part.count) / total)
            apart = surface.closest(positions, progress=searching).distance
            result.apart.add(part, apart, areas)
            part.keep_largest(result.at_vertices, apart)
            slide = positions - surface.evaluate(face, uv).position
            result.slide.add(part, np.linalg.norm(slide, axis=1), areas)
            done += part.count
            progress(done / total)
    return result
