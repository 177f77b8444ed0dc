# SPDX-License-Identifier: Apache-2.0
"""The surface does not depend on the order of vertices, faces and corners, nor on which side of the
mesh is the front: edges of different sharpness decay in the same way.
"""

import limitsurf as ls
import numpy as np
import pytest
import shapes

SIDE = 5
PLACES = 40  # a face


def random_mesh(rng, creasing):
    """A wavy sheet whose edges and vertices have random sharpness; some edges are smooth, and some
    infinitely sharp.
    """
    positions, faces = shapes.grid(SIDE, SIDE)
    positions = positions + rng.normal(0, 0.2, positions.shape)
    edges = np.unique(np.sort(np.vstack([faces, np.roll(faces, -1, 1)]).reshape(2, -1).T), axis=0)
    values = rng.uniform(0, 4.7, len(edges)) * (rng.random(len(edges)) < 0.7)
    values[rng.random(len(edges)) < 0.05] = np.inf
    vertices = rng.uniform(0, 3, len(positions)) * (rng.random(len(positions)) < 0.2)
    return positions, faces, edges, values, vertices, creasing


def surface_of(positions, faces, edges, values, vertices, creasing):
    return ls.LimitSurface(
        ls.ControlMesh.from_faces(
            positions,
            faces,
            edge_sharpness=(edges, values),
            vertex_sharpness=(np.arange(len(positions)), vertices),
            creasing=creasing,
        )
    )


def reordered(mesh, rng, mirrored):
    """Returns the mesh in another order, the faces' new numbers, and how often the corners of each
    face were turned.
    """
    positions, faces, edges, values, vertices, creasing = mesh
    old = rng.permutation(len(positions))  # of each new vertex
    new = np.argsort(old)
    faces, edges = new[faces], new[edges]
    if mirrored:
        faces = faces[:, [0, 3, 2, 1]]
    turns = rng.integers(0, 4, len(faces))
    faces = np.stack([np.roll(face, -turn) for face, turn in zip(faces, turns, strict=True)])
    order, edge_order = rng.permutation(len(faces)), rng.permutation(len(edges))
    edges = np.where(rng.random((len(edges), 1)) < 0.5, edges, edges[:, ::-1])
    made = (
        *(positions[old], faces[order], edges[edge_order], values[edge_order], vertices[old]),
        creasing,
    )
    return made, np.argsort(order), turns


def turned(uv, turns):
    """The same places after the corners of their faces have been turned."""
    result = uv.copy()
    for turn in range(1, 4):
        more = turns >= turn
        result[more] = np.stack([result[more, 1], 1 - result[more, 0]], axis=1)
    return result


@pytest.mark.parametrize("creasing", ["uniform", "chaikin"])
@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_positions_do_not_depend_on_order(creasing, mirrored, seed):
    rng = np.random.default_rng(seed)
    mesh = random_mesh(rng, creasing)
    face = np.repeat(np.arange(SIDE * SIDE), PLACES)
    uv = rng.random((len(face), 2))
    uv[::3] *= 2.0 ** -rng.integers(0, 20, (len(uv[::3]), 1))  # near vertices
    uv[::4] = np.round(uv[::4])
    before = surface_of(*mesh).evaluate(face, uv).position
    other, number, turns = reordered(mesh, rng, mirrored)
    if mirrored:
        uv = uv[:, ::-1]
    after = surface_of(*other).evaluate(number[face], turned(uv, turns[face])).position
    assert len(face) == SIDE * SIDE * PLACES
    diagonal = np.linalg.norm(np.ptp(mesh[0], axis=0))
    assert np.abs(after - before).max() <= 1e-13 * diagonal
