# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers by which vertices that were added later are told from those that have places.

Where an edit adds vertices to a mesh, Blender gives them averages of their neighbours' attributes,
also of the numbers of faces: a place that means nothing. So each vertex that has a place is given a
seal: a number that is made of its place, and two functions of that number, which averages of two
seals do not keep. The chance is 2^-48 that one does; 2^-24 is the chance that two places have the
same seal, and averages of these are not noticed. A seal of 0 stands for vertices that were bound
before there were seals; their places are trusted.
"""

from __future__ import annotations

import bpy
import numpy as np

from .. import ids
from ..reading import attributes

KIND = "FLOAT_VECTOR"
#: All numbers of seals are multiples of this, so that single precision holds them exactly
_UNIT = 2.0**-24
_FACTORS = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
_SHIFT = np.uint64(40)

#: By the meshes' session_uid: the numbers of their vertices, and of those whose seals are broken
_counts: dict[int, tuple[int, int]] = {}


def seal(data: bpy.types.ID, rows: np.ndarray) -> None:
    """Says of these vertices of a mesh that their places are their own; the others keep what they
    have. Does nothing for other data, whose edits copy places as a whole, nor for a mesh none of
    whose vertices has a place: it may lack the attributes of places.
    """
    if not isinstance(data, bpy.types.Mesh) or (len(data.vertices) and not len(rows)):
        return
    values = np.zeros((len(data.vertices), 3), np.float32)
    if _has_seals(data):
        values[:] = attributes.read(data, ids.SEAL)
    values[rows] = _functions(_numbers_of_places(data)[rows])
    attributes.write(data, ids.SEAL, KIND, "POINT", values)
    _counts.pop(data.session_uid, None)


def are_broken(data: bpy.types.ID) -> np.ndarray | None:
    """Tells which vertices have got their places as averages of others (a mask). Returns None
    where that is not known, because there are no seals.
    """
    if not _has_seals(data):
        return None
    values = attributes.read(data, ids.SEAL)
    first = np.where((values[:, 0] > 0) & (values[:, 0] < 1), values[:, 0], 0)
    numbers = first.astype(np.float64) / _UNIT
    expected = _functions(np.rint(numbers).astype(np.int64).astype(np.uint64))
    is_seal = (values == expected).all(axis=1) & (numbers == np.rint(numbers))
    broken: np.ndarray = values.any(axis=1) & ~is_seal
    return broken


def count_broken(data: bpy.types.ID) -> int:
    """Returns the number of such vertices. It is kept as long as the mesh has as many vertices and
    is not sealed again, because panels ask for it whenever they are drawn.
    """
    if not _has_seals(data):
        return 0
    size, count = _counts.get(data.session_uid, (-1, 0))
    if size != len(data.vertices):
        broken = are_broken(data)
        count = 0 if broken is None else int(broken.sum())
        _counts[data.session_uid] = len(data.vertices), count
    return count


def forget() -> None:
    """Is called when meshes may be others than before: after undo, and for another file."""
    _counts.clear()


def nearest_placed(mesh: bpy.types.Mesh, has_place: np.ndarray) -> np.ndarray:
    """Returns for each vertex one that has a place (a mask): itself, or that which the fewest edges
    lead to. Where none is connected, it is -1. Cost: O(vertices + edges log edges).
    """
    nearest = np.where(has_place, np.arange(len(has_place)), -1)
    edges = attributes.edge_ends(mesh)
    edges = edges[~has_place[edges].all(axis=1)]
    begin, end = np.concatenate([edges, edges[:, ::-1]]).T
    order = np.argsort(begin, kind="stable")
    end = end[order]
    first = np.searchsorted(begin[order], np.arange(len(has_place) + 1))
    front = np.unique(begin[has_place[begin]])
    while len(front):
        sizes = first[front + 1] - first[front]
        row = np.repeat(np.arange(len(front)), sizes)
        at = np.arange(len(row)) - np.repeat(np.cumsum(sizes) - sizes, sizes) + first[front][row]
        found = end[at]
        new = nearest[found] < 0
        nearest[found[new]] = nearest[front[row[new]]]
        front = np.unique(found[new])
    return nearest


def carriers(mesh: bpy.types.Mesh, broken: np.ndarray, has_place: np.ndarray) -> np.ndarray:
    """Returns for each vertex the one that carries it: itself, or for those whose seals are broken
    (a mask), the nearest one that has a place, where edges lead to one.
    """
    carrier = np.arange(len(broken))
    if broken.any():
        nearest = nearest_placed(mesh, has_place)
        carried = broken & (nearest >= 0)
        carrier[carried] = nearest[carried]
    return carrier


def _has_seals(data: bpy.types.ID) -> bool:
    stored = data.attributes.get(ids.SEAL) if isinstance(data, bpy.types.Mesh) else None
    return stored is not None and (stored.data_type, stored.domain) == (KIND, "POINT")


def _numbers_of_places(mesh: bpy.types.Mesh) -> np.ndarray:
    """Returns a number from 1 to 2^24 - 1 for each vertex, the same where the places are."""
    numbers = np.zeros(len(mesh.vertices), np.uint64)
    for name in (ids.FACE, ids.UV, ids.REST_ROOT, ids.REST_ROTATION):
        values = attributes.read(mesh, name)
        for column in np.atleast_2d(values.view(np.uint32).T):
            numbers = (numbers ^ column) * _FACTORS[0]
            numbers ^= numbers >> np.uint64(29)
    return np.maximum(numbers >> _SHIFT, np.uint64(1))


def _functions(numbers: np.ndarray) -> np.ndarray:
    """Returns the seals (n, 3) that begin with these numbers below 2^24."""
    others = [(numbers * numbers * factor) >> _SHIFT for factor in _FACTORS[1:]]
    values: np.ndarray = (np.stack([numbers, *others], axis=1) * _UNIT).astype(np.float32)
    return values
