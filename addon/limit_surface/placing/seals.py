# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers by which vertices that were added later are told from those that have places.

Where an edit adds vertices to a mesh, Blender gives them averages of their neighbours' attributes,
also of the numbers of faces: a place that means nothing. So each vertex that has a place is given a
seal: a number whose lower half is a function of the upper half, which averages do not keep. The
chance is 2^-16 that one does. A seal of 0 stands for vertices that were bound before there were
seals; their places are trusted.
"""

from __future__ import annotations

import bpy
import numpy as np

from .. import ids
from ..reading import attributes

_HALF = np.uint32(16)
_LOWER = np.uint32(0xFFFF)


def seal(data: bpy.types.ID, rows: np.ndarray) -> None:
    """Says of these vertices of a mesh that their places are their own; the others keep what they
    have. Does nothing for other data, whose edits copy places as a whole.
    """
    if not isinstance(data, bpy.types.Mesh):
        return
    count = len(data.vertices)
    values = attributes.read(data, ids.SEAL) if _has_seals(data) else np.zeros(count, np.int32)
    values[rows] = _seals(count)[rows]
    attributes.write(data, ids.SEAL, "INT", "POINT", values)


def are_broken(data: bpy.types.ID) -> np.ndarray | None:
    """Tells which vertices have got their places as averages of others (a mask). Returns None
    where that is not known, because there are no seals.
    """
    if not _has_seals(data):
        return None
    values = attributes.read(data, ids.SEAL).view(np.uint32)
    broken: np.ndarray = (values != 0) & ((values & _LOWER) != _lower_half(values >> _HALF))
    return broken


def _has_seals(data: bpy.types.ID) -> bool:
    stored = data.attributes.get(ids.SEAL) if isinstance(data, bpy.types.Mesh) else None
    return stored is not None and (stored.data_type, stored.domain) == ("INT", "POINT")


def _seals(count: int) -> np.ndarray:
    upper = np.arange(count, dtype=np.uint32) * np.uint32(0x9E3779B1) >> _HALF | np.uint32(1)
    return (upper << _HALF | _lower_half(upper)).view(np.int32)


def _lower_half(upper: np.ndarray) -> np.ndarray:
    half: np.ndarray = upper * upper * np.uint32(0x85EBCA6B) >> _HALF
    return half
