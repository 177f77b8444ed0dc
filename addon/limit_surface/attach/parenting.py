# SPDX-License-Identifier: GPL-3.0-or-later
"""Parenting to three vertices that moves nothing.

The parent's matrix there is read from empties that are parented in the same way for a moment: what
an attached object's own matrix would tell is hidden by its animation, drivers and constraints.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bpy
import numpy as np
from mathutils import Matrix

from .. import ids
from ..placing import proxy
from ..reading import private_scene, rigid_bodies

# The time that Blender takes to remove objects grows with the square of their number.
MOST_PROBES = 256


def parent_matrices(
    context: bpy.types.Context, parents: Sequence[tuple[bpy.types.Object, Sequence[int]]]
) -> list[np.ndarray]:
    """Returns the matrices (4, 4) of parents, given with three of their vertices."""
    probes: list[bpy.types.Object] = []
    matrices: list[np.ndarray] = []
    with proxy.aside(), _scene_for(context, len(parents)) as (scene, layer):
        try:
            for _ in parents[:MOST_PROBES]:
                probe = bpy.data.objects.new(ids.CARRIED_BY, None)
                probes.append(probe)
                scene.collection.objects.link(probe)
            while len(matrices) < len(parents):
                # There may be fewer parents left than probes.
                part = list(zip(probes, parents[len(matrices) :], strict=False))
                for probe, (parent, vertices) in part:
                    _set_parent(probe, parent, vertices)
                layer.update()
                for probe, _ in part:
                    posed = probe.evaluated_get(layer.depsgraph)
                    matrices.append(np.array(posed.matrix_world, np.float64))
        finally:
            bpy.data.batch_remove(probes)  # one after the other they would take seconds
    return matrices


@contextmanager
def _scene_for(
    context: bpy.types.Context, count: int
) -> Iterator[tuple[bpy.types.Scene, bpy.types.ViewLayer]]:
    """Yields the user's scene and view layer for a few probes. Many would cause all of its objects
    to be evaluated many times, so they are in a private scene, unless rigid bodies move there.
    """
    if count <= MOST_PROBES or rigid_bodies.are_simulated(context.scene):
        yield context.scene, context.view_layer
        return
    with private_scene.like(context.scene) as scene:
        yield scene, private_scene.layer(scene, context.view_layer)


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
