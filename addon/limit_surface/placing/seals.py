# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers by which vertices that were added later are told from those that have places.

Where an edit adds vertices to a mesh, Blender gives them averages of their neighbours' attributes,
also of the numbers of faces: a place that means nothing. So each vertex that has a place is given a
seal: a random number and two functions of it, which averages of two seals do not keep. The chance
is 2^-48 that one does, or that both seals are the same. A seal of 0 stands for vertices that were
bound before there were seals; their places are trusted.
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


def seal(data: bpy.types.ID, rows: np.ndarray) -> None:
    """Says of these vertices of a mesh that their places are their own; the others keep what they
    have. Does nothing for other data, whose edits copy places as a whole.
    """
    if not isinstance(data, bpy.types.Mesh):
        return
    count = len(data.vertices)
    values = np.zeros((count, 3), np.float32)
    if _has_seals(data):
        values[:] = attributes.read(data, ids.SEAL)
    values[rows] = _seals(count)[rows]
    attributes.write(data, ids.SEAL, KIND, "POINT", values)


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
    broken = are_broken(data)
    return 0 if broken is None else int(broken.sum())


def nearest_placed(mesh: bpy.types.Mesh, has_place: np.ndarray) -> np.ndarray:
    """Returns for each vertex one that has a place (a mask): itself, or that which the fewest edges
    lead to. Where none is connected, it is -1.
    """
    nearest = np.where(has_place, np.arange(len(has_place)), -1)
    edges = attributes.read(mesh, ids.EDGE_VERTICES)
    while len(edges):
        known = nearest[edges] >= 0
        open_ends = known.sum(axis=1) == 1
        if not open_ends.any():
            break
        begin, end = edges[open_ends].T
        forwards = known[open_ends, 0]
        nearest[np.where(forwards, end, begin)] = nearest[np.where(forwards, begin, end)]
        edges = edges[~known.all(axis=1)]
    return nearest


def _has_seals(data: bpy.types.ID) -> bool:
    stored = data.attributes.get(ids.SEAL) if isinstance(data, bpy.types.Mesh) else None
    return stored is not None and (stored.data_type, stored.domain) == (KIND, "POINT")


def _seals(count: int) -> np.ndarray:
    numbers = (np.arange(1, count + 1, dtype=np.uint64) * _FACTORS[0]) >> _SHIFT
    return _functions(np.maximum(numbers, np.uint64(1)))


def _functions(numbers: np.ndarray) -> np.ndarray:
    """Returns the seals (n, 3) that begin with these numbers below 2^24."""
    others = [(numbers * numbers * factor) >> _SHIFT for factor in _FACTORS[1:]]
    values: np.ndarray = (np.stack([numbers, *others], axis=1) * _UNIT).astype(np.float32)
    return values
