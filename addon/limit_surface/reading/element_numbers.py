# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes as numbers on the edges or vertices of a mesh, whatever their type and domain.

They are converted as Blender converts them wherever it reads an attribute by name: first to the
domain, in the attribute's own type, and then to single precision.
"""

import bpy
import numpy as np

from .. import ids
from . import attributes, ragged_rows

TYPES = ("FLOAT", "INT", "INT8", "BOOLEAN")
#: Types that Blender cannot convert to a number. It treats such an attribute as if it did not
#: exist.
WITHOUT_NUMBERS = ("STRING", "QUATERNION", "FLOAT4X4")
#: An element of these domains becomes true if any of its neighbours is true; in other domains, only
#: if all of them are.
_ANY = (("FACE", "EDGE"), ("FACE", "POINT"), ("EDGE", "POINT"))


def numbers(mesh: bpy.types.Mesh, name: str, domain: str) -> np.ndarray:
    """Returns the numbers of an attribute of one of the TYPES on EDGE or POINT."""
    attribute = mesh.attributes[name]
    values = attributes.read(mesh, name)
    if attribute.domain != domain:
        element, at = _neighbours(mesh, attribute.domain, domain)
        count = len(mesh.edges if domain == "EDGE" else mesh.vertices)
        if attribute.data_type == "BOOLEAN":
            values = _truth(values[at], element, count, (attribute.domain, domain) in _ANY)
        elif attribute.data_type == "FLOAT":
            values = _mean(values[at], element, count)
        else:
            values = _rounded(_mean(values[at].astype(np.float64), element, count))
    return values.astype(np.float32)


def _neighbours(mesh: bpy.types.Mesh, source: str, target: str) -> tuple[np.ndarray, np.ndarray]:
    """Returns elements of the target's domain, and for each of them an adjacent element of the
    source's domain.
    """
    if {source, target} == {"EDGE", "POINT"}:
        vertex = attributes.read(mesh, ids.EDGE_VERTICES).ravel()
        edge = np.repeat(np.arange(len(mesh.edges)), 2)
        return (edge, vertex) if target == "EDGE" else (vertex, edge)
    to = attributes.read(mesh, ids.CORNER_EDGE if target == "EDGE" else ids.CORNER_VERTEX)
    sizes = attributes.face_sizes(mesh)
    if source == "FACE":
        return to, np.repeat(np.arange(len(sizes)), sizes)
    corner = np.arange(len(to))
    if target == "POINT":
        return to, corner
    both_ends = np.stack([corner, ragged_rows.following(sizes)], axis=1)
    return np.repeat(to, 2), both_ends.ravel()


def _mean(values: np.ndarray, element: np.ndarray, count: int) -> np.ndarray:
    """Returns the mean of all the values that an element has; 0 where it has none."""
    total = np.zeros(count, values.dtype)
    np.add.at(total, element, values)
    weight = np.bincount(element, minlength=count).astype(values.dtype)
    return np.divide(total, weight, out=total, where=weight > 0)


def _rounded(values: np.ndarray) -> np.ndarray:
    """Returns integers; halves are rounded away from 0."""
    return np.copysign(np.floor(np.abs(values) + 0.5), values)


def _truth(values: np.ndarray, element: np.ndarray, count: int, if_any: bool) -> np.ndarray:
    true = np.bincount(element[values], minlength=count)
    if if_any:
        return true > 0
    return (true > 0) & (true == np.bincount(element, minlength=count))
