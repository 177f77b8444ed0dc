# SPDX-License-Identifier: GPL-3.0-or-later
"""Parenting to three vertices that moves nothing.

The parent's matrix there is read from empties that are parented in the same way for a moment: what
an attached object's own matrix would tell is hidden by its animation, drivers and constraints.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from mathutils import Matrix

from .. import ids


def parent_matrices(
    context: bpy.types.Context, parents: Sequence[tuple[bpy.types.Object, Sequence[int]]]
) -> list[np.ndarray]:
    """Returns the matrices (4, 4) of parents, given with three of their vertices."""
    probes = []
    try:
        for parent, vertices in parents:
            probe = bpy.data.objects.new(parent.name, None)
            probes.append(probe)
            context.scene.collection.objects.link(probe)
            _set_parent(probe, parent, vertices)
        context.view_layer.update()
        return [np.array(probe.matrix_world, np.float64) for probe in probes]
    finally:
        bpy.data.batch_remove(probes)  # one after the other they would take seconds


def attach(
    ob: bpy.types.Object,
    parent: bpy.types.Object,
    vertices: Sequence[int],
    was: np.ndarray,
    now: np.ndarray,
) -> None:
    """Makes an object the child of three vertices. `was` and `now` are the matrices of its parents
    before and after, so that it stays where it is, with its own transform unchanged.
    """
    inverse = np.linalg.solve(now, was @ np.array(ob.matrix_parent_inverse, np.float64))
    _set_parent(ob, parent, vertices)
    ob.matrix_parent_inverse = Matrix(inverse)
    # Blender saves an object only if it has users. A scene can be deleted, and an object's children
    # are no users, but custom properties are.
    ob[ids.CARRIED_BY] = parent


def _set_parent(ob: bpy.types.Object, parent: bpy.types.Object, vertices: Sequence[int]) -> None:
    ob.parent, ob.parent_type = parent, "VERTEX_3"
    ob.parent_vertices = [int(vertex) for vertex in vertices]
    ob.matrix_parent_inverse.identity()
