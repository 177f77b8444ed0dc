# SPDX-License-Identifier: Apache-2.0
"""Catmull-Clark subdivision spelled out, for smooth meshes with smooth boundaries."""

import numpy as np


def subdivided(positions, faces, levels=1):
    """(positions, faces): the faces of each face in the order of its corners; a quad's are turned
    as it is, others begin at their corner."""
    positions, faces = np.asarray(positions, float), [list(face) for face in faces]
    for _ in range(levels):
        positions, faces = _step(positions, faces)
    return positions, faces


def _step(positions, faces):
    edges, faces_at = {}, [[] for _ in positions]
    for f, face in enumerate(faces):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            edges.setdefault(frozenset((a, b)), []).append(f)
        for vertex in face:
            faces_at[vertex].append(f)
    number = {edge: len(positions) + i for i, edge in enumerate(edges)}
    centres = np.array([positions[face].mean(axis=0) for face in faces])
    middles = {edge: positions[list(edge)].mean(axis=0) for edge in edges}
    on_edges = [
        middles[edge] if len(of) == 1 else (middles[edge] + centres[of].mean(axis=0)) / 2
        for edge, of in edges.items()
    ]
    edges_at = [[] for _ in positions]
    for edge in edges:
        for vertex in edge:
            edges_at[vertex].append(edge)
    moved = [
        _moved(positions[v], v, edges_at[v], edges, middles, centres[faces_at[v]], positions)
        for v in range(len(positions))
    ]
    first_centre = len(positions) + len(edges)
    children = []
    for f, face in enumerate(faces):
        sides = [number[frozenset((a, b))] for a, b in zip(face, face[1:] + face[:1], strict=True)]
        for corner, vertex in enumerate(face):
            child = [vertex, sides[corner], first_centre + f, sides[corner - 1]]
            turn = corner if len(face) == 4 else 0
            children.append(child[4 - turn :] + child[: 4 - turn])
    return np.concatenate([moved, on_edges, centres]), children


def _moved(position, vertex, own_edges, edges, middles, centres, positions):
    boundary = [edge for edge in own_edges if len(edges[edge]) == 1]
    if boundary:
        ends = [positions[next(iter(edge - {vertex}))] for edge in boundary]
        return 0.75 * position + 0.125 * (ends[0] + ends[1])
    n = len(own_edges)
    around = np.mean([middles[edge] for edge in own_edges], axis=0)
    return (centres.mean(axis=0) + 2 * around + (n - 3) * position) / n
