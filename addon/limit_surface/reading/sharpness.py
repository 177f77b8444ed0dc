# SPDX-License-Identifier: GPL-3.0-or-later
"""The sharpness of a mesh's edges and vertices where Blender subdivides it.

It is calculated in single precision, as Blender does: a difference in the last bit of a fractional
sharpness would change the surface.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..errors import CageError
from . import attributes, element_numbers

INFINITE = np.float32(10)  # this crease, and every larger one, is infinitely sharp
OF_CREASE_1 = np.float32(10)  # other creases have the square of their value times this sharpness
LEAST = np.float32(1e-6)  # smaller values on edges count as no crease


@dataclass(frozen=True)
class Sharpness:
    edges: np.ndarray  # (n, 2) vertices
    edge_values: np.ndarray
    vertices: np.ndarray
    vertex_values: np.ndarray


NOTHING = Sharpness(np.empty((0, 2), np.int32), np.empty(0), np.empty(0, np.int32), np.empty(0))


def read(mesh: bpy.types.Mesh, use_creases: bool, whose: str) -> Sharpness:
    """Returns the edges of faces and the vertices of faces whose sharpness is not 0. Raises
    CageError, which names `whose` mesh it is, where creases are not numbers.
    """
    ends = attributes.read(mesh, ids.EDGE_VERTICES)
    in_face, vertex_in_face = (np.zeros(len(c), bool) for c in (mesh.edges, mesh.vertices))
    in_face[attributes.read(mesh, ids.CORNER_EDGE)] = True
    vertex_in_face[attributes.read(mesh, ids.CORNER_VERTEX)] = True

    edge, vertex = np.zeros(len(mesh.edges), np.float32), np.zeros(len(mesh.vertices), np.float32)
    if use_creases:
        edge = _from_creases(mesh, whose, ids.EDGE_CREASE, "EDGE", edge)
        vertex = _from_creases(mesh, whose, ids.VERTEX_CREASE, "POINT", vertex)
    edge[edge < LEAST] = 0
    vertex = _with_edges_of_two(vertex, ends[in_face], edge[in_face])
    # loose edges are not part of the surface, but they count where two edges meet
    vertex[ends[~in_face]] = INFINITE

    edges = np.flatnonzero(in_face & (edge != 0))
    vertices = np.flatnonzero(vertex_in_face & (vertex != 0))
    return Sharpness(ends[edges], edge[edges], vertices, vertex[vertices])


def _from_creases(
    mesh: bpy.types.Mesh, whose: str, name: str, domain: str, uncreased: np.ndarray
) -> np.ndarray:
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.data_type in element_numbers.WITHOUT_NUMBERS:
        return uncreased
    if attribute.data_type not in element_numbers.TYPES:
        raise CageError(
            f"{whose}: the attribute {name} is of type {attribute.data_type}. Creases of that "
            f"type are not supported: convert it to FLOAT on {domain}"
        )
    crease = element_numbers.numbers(mesh, name, domain)
    missing = np.flatnonzero(np.isnan(crease))
    if missing.size:
        element = "edge" if domain == "EDGE" else "vertex"
        raise CageError(
            f"{whose}: the crease of {element} {missing[0]} is not a number (attribute {name}; "
            f"{missing.size} in all)"
        )
    crease = crease.clip(-1, 1)  # the square of a larger crease is infinitely sharp, too
    return crease * crease * OF_CREASE_1


def _with_edges_of_two(vertex: np.ndarray, ends: np.ndarray, edge: np.ndarray) -> np.ndarray:
    """A vertex at which exactly two edges meet gets the sum of their sharpness, in addition to its
    own.
    """
    if not edge.any():
        return vertex
    least = np.full(len(vertex), np.inf, np.float32)
    np.minimum.at(least, ends, edge[:, None])
    of_two = np.bincount(ends.ravel(), minlength=len(vertex)) == 2
    return np.where(of_two, np.minimum(vertex + least, INFINITE), vertex)
