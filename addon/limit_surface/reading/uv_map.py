# SPDX-License-Identifier: GPL-3.0-or-later
"""A cage's UV map: one value for the corners that Blender subdivides as one.

Where the corners around a vertex share a value the map is smooth there; where they do not, a seam
runs through it. Marks of seams on edges have no say.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from . import attributes, ragged_rows

LIMIT = np.float32(1e-4)  # corners of a vertex that differ by less along each axis share a value


@dataclass(frozen=True)
class UvMap:
    name: str
    values: np.ndarray  # (m, 2)
    indices: np.ndarray  # one per face corner of the cage


def obstacle(mesh: bpy.types.Mesh, name: str) -> str:
    """Why the map of that name cannot be read from a mesh as modifiers leave it, if so."""
    if name not in mesh.uv_layers:
        return f"the UV map {name} does not outlast the modifiers"
    if not np.isfinite(attributes.read(mesh, name)).all():
        return f"the UV map {name} has coordinates that are not finite numbers"
    return ""


def read(mesh: bpy.types.Mesh, name: str) -> UvMap:
    uv = attributes.read(mesh, name)
    corner_vertex = attributes.read(mesh, ids.CORNER_VERTEX)
    face_sizes = attributes.face_sizes(mesh)
    leader = _leaders(uv, corner_vertex, np.repeat(_is_mirrored(uv, face_sizes), face_sizes))
    leads = leader == np.arange(len(uv))
    return UvMap(name, uv[leads].astype(np.float64), (np.cumsum(leads) - 1)[leader])


def _leaders(uv: np.ndarray, corner_vertex: np.ndarray, mirrored: np.ndarray) -> np.ndarray:
    """For each corner the one whose value it takes, chosen as Blender does.

    The last corner of a vertex takes along all that are close to it and turned the same way; of
    the rest the last one does, and so on. So who is close to whom depends on that order.
    """
    leader = np.arange(len(uv))
    last = np.empty(corner_vertex.max(initial=-1) + 1, int)
    rest = leader
    while rest.size:
        vertex = corner_vertex[rest]
        last[vertex] = rest  # ascending: the last stays
        to = last[vertex]
        close = (np.abs(uv[rest] - uv[to]) < LIMIT).all(axis=1) & (mirrored[rest] == mirrored[to])
        leader[rest[close]] = to[close]
        rest = rest[~close & (rest != to)]
    return leader


def _is_mirrored(uv: np.ndarray, face_sizes: np.ndarray) -> np.ndarray:
    """Whether a face's corners run clockwise on the map; faces of no area there do not."""
    before = ragged_rows.preceding(face_sizes)
    strips = (uv[before, 0] - uv[:, 0]) * (uv[:, 1] + uv[before, 1])
    return np.add.reduceat(strips, ragged_rows.starts(face_sizes)) < 0
