# SPDX-License-Identifier: Apache-2.0
"""Cameras and mapped surfaces for the tests of projection, and their views computed by numpy."""

import limitsurf as ls
import numpy as np
import shapes


def looking(eye, at, up=(0.0, 0.0, 1.0)):
    """The view matrix of a camera that looks along its own -z."""
    eye, at, up = (np.asarray(x, float) for x in (eye, at, up))
    back = (eye - at) / np.linalg.norm(eye - at)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    view = np.eye(4)
    view[:3, :3] = [right, np.cross(back, right), back]
    view[:3, 3] = -view[:3, :3] @ eye
    return view


def perspective(half_width=0.5, half_height=0.5, near=0.1, far=100.0, shift=(0.0, 0.0)):
    """A perspective matrix whose frame is 2 half_width x 2 half_height at distance 1."""
    return np.array(
        [
            [1 / half_width, 0, shift[0], 0],
            [0, 1 / half_height, shift[1], 0],
            [0, 0, -(far + near) / (far - near), -2 * far * near / (far - near)],
            [0, 0, -1, 0],
        ]
    )


def orthographic(half_width=1.0, half_height=1.0, near=0.1, far=100.0):
    return np.array(
        [
            [1 / half_width, 0, 0, 0],
            [0, 1 / half_height, 0, 0],
            [0, 0, -2 / (far - near), -(far + near) / (far - near)],
            [0, 0, 0, 1],
        ]
    )


def image_of(matrix, points):
    """The st of points, by definition."""
    clip = points @ matrix[:, :3].T + matrix[:, 3]
    return (clip[:, :2] / clip[:, 3:] + 1) / 2


def sheet(columns=6, rows=5, height=0.3, interpolation="none", seed=1):
    """A curved open mesh over [0, 1]^2 without seams: (surface, its map of a square)."""
    x, y = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    rng = np.random.default_rng(seed)
    z = height * np.sin(5 * x + 1) * np.cos(4 * y)
    positions = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    positions += rng.uniform(-0.02, 0.02, positions.shape)
    faces = shapes.grid_faces(columns, rows)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    places = np.stack([x, y], axis=-1).reshape(-1, 2)
    places = places + 0.05 * np.sin(7 * places[:, ::-1])
    return surface, surface.face_varying(places, faces.ravel(), interpolation)


def plane(side=4, height=0.0, turned=False):
    """Squares over [0, 1]^2 in the plane z = height, with pinned corners, and the map (x, y)."""
    steps = np.linspace(0, 1, side + 1)
    x, y = np.meshgrid(steps, steps)
    places = np.stack([x, y], axis=-1).reshape(-1, 2)
    positions = np.column_stack([places, np.full(len(places), height)])
    faces = shapes.grid_faces(side, side)
    if turned:
        faces = faces[:, ::-1]
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, scheme="bilinear"))
    return surface, surface.face_varying(places, faces.ravel(), "all")


def mapped(positions, faces, **rules):
    """A surface, each face of which has a square of its own in the map: (surface, map)."""
    mesh = ls.ControlMesh.from_faces(positions, faces, **rules)
    surface = ls.LimitSurface(mesh)
    side = int(np.ceil(np.sqrt(len(mesh.face_sizes))))
    values = []
    for face, size in enumerate(mesh.face_sizes):
        angle = 2 * np.pi * (np.arange(size) + 0.5) / size
        corner = np.array([face % side, face // side])
        values.append((corner + 0.5 + 0.45 * np.stack([np.cos(angle), np.sin(angle)], 1)) / side)
    values = np.concatenate(values)
    return surface, surface.face_varying(values, np.arange(len(values)), "all")
