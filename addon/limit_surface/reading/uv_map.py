# SPDX-License-Identifier: GPL-3.0-or-later
"""A cage's UV map, in which corners that Blender subdivides together share one value.

Where the corners around a vertex share a value the map is smooth there; where they do not, a seam
runs through the vertex. Edges that are marked as seams make no difference.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from . import attributes, ragged_rows

# corners of a vertex share a value if they differ by less than this along each axis
LIMIT = np.float32(1e-4)


@dataclass(frozen=True)
class UvMap:
    name: str
    values: np.ndarray  # (m, 2)
    indices: np.ndarray  # the row of the value for each face corner of the cage


def obstacle(mesh: bpy.types.Mesh, name: str) -> str:
    """Returns the reason why the map of that name cannot be read from a mesh after its modifiers,
    or None.
    """
    if name not in mesh.uv_layers:
        return f"the modifiers remove the UV map {name}"
    if not np.isfinite(attributes.read(mesh, name)).all():
        return f"the UV map {name} has coordinates that are not finite numbers"
    return ""


def read(mesh: bpy.types.Mesh, name: str) -> UvMap:
    uv = attributes.read(mesh, name)
    corner_vertex = attributes.read(mesh, ids.CORNER_VERTEX)
    face_sizes = attributes.face_sizes(mesh)
    with np.errstate(over="ignore", invalid="ignore"):  # users may have moved corners anywhere
        leader = _leaders(uv, corner_vertex, np.repeat(_is_mirrored(uv, face_sizes), face_sizes))
    leads = leader == np.arange(len(uv))
    return UvMap(name, uv[leads].astype(np.float64), (np.cumsum(leads) - 1)[leader])


def _leaders(uv: np.ndarray, corner_vertex: np.ndarray, mirrored: np.ndarray) -> np.ndarray:
    """Returns for each corner the one whose value it takes, chosen as Blender does.

    The last corner of a vertex is a leader. All corners that are close to it, and whose faces have
    the same orientation on the map, take its value; the last of the remaining corners is the next
    leader, and so on. So the result depends on that order.
    """
    leader = np.arange(len(uv))
    last = np.empty(corner_vertex.max(initial=-1) + 1, int)
    rest = leader
    while rest.size:
        vertex = corner_vertex[rest]
        last[vertex] = rest  # rows are ascending, so the last one stays
        to = last[vertex]
        close = (np.abs(uv[rest] - uv[to]) < LIMIT).all(axis=1) & (mirrored[rest] == mirrored[to])
        leader[rest[close]] = to[close]
        rest = rest[~close & (rest != to)]
    return leader


def _is_mirrored(uv: np.ndarray, face_sizes: np.ndarray) -> np.ndarray:
    """Tells whether a face's corners run clockwise on the map; this is false for faces without area
    there.
    """
    before = ragged_rows.preceding(face_sizes)
    strips = (uv[before, 0] - uv[:, 0]) * (uv[:, 1] + uv[before, 1])
    return np.add.reduceat(strips, ragged_rows.starts(face_sizes)) < 0
