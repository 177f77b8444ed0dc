# SPDX-License-Identifier: GPL-3.0-or-later
"""The truth for projected images: Blender's own mesh, so finely subdivided that it is the limit
surface, its own UVs, and rays of its own camera. None of this uses the add-on.
"""

from __future__ import annotations

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.reading import attributes
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree


def fine_subsurf(ob: bpy.types.Object, level: int = 5) -> bpy.types.SubsurfModifier:
    """Adds a modifier that puts vertices on the limit surface, up to single precision."""
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.levels = subsurf.render_levels = level
    subsurf.quality = 10
    return subsurf


class FineMesh:
    """The fine mesh in the world."""

    def __init__(self, ob: bpy.types.Object) -> None:
        mesh = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        matrix = np.array(ob.matrix_world, np.float64)
        local = attributes.read(mesh, ids.POSITION).astype(np.float64)
        self.positions = local @ matrix[:3, :3].T + matrix[:3, 3]
        self.corners = attributes.read(mesh, ids.CORNER_VERTEX).reshape(-1, 4)
        self.uv = attributes.read(mesh, mesh.uv_layers.active.name).reshape(-1, 4, 2)
        halves = [[0, 1, 2], [0, 2, 3]]
        self._triangles = self.corners[:, halves].reshape(-1, 3)
        self._uv = self.uv[:, halves].reshape(-1, 3, 2).astype(np.float64)
        self._tree = BVHTree.FromPolygons(self.positions.tolist(), self._triangles.tolist())

    def seen(self, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Returns the places (n, 2) on the UV map that rays hit first; NaN where they miss."""
        hits = [
            self._tree.ray_cast(Vector(o), Vector(d))
            for o, d in zip(origins.tolist(), directions.tolist(), strict=True)
        ]
        found = np.full((len(hits), 2), np.nan)
        rows = np.array([i for i, hit in enumerate(hits) if hit[2] is not None], int)
        if rows.size:
            triangle = np.array([hits[i][2] for i in rows])
            points = np.array([hits[i][0] for i in rows])
            a, b, c = self.positions[self._triangles[triangle]].transpose(1, 0, 2)
            sides = np.stack([b - a, c - a], axis=2)
            weights = np.linalg.pinv(sides) @ (points - a)[:, :, None]
            weights = np.column_stack([1 - weights.sum(axis=1), weights[:, :, 0]])
            found[rows] = np.einsum("ni,nij->nj", weights, self._uv[triangle])
        return found


def posed(ob: bpy.types.Object, mirrored: bool = False) -> bpy.types.Object:
    """Moves, turns and stretches the object by a matrix of its own, and returns it."""
    ob.matrix_world = (
        Matrix.Translation((1, -2, 0.5))
        @ Matrix.Rotation(0.4, 4, (1, 2, 3))
        @ Matrix.Diagonal((-0.7 if mirrored else 0.7, 1.2, 0.9, 1))
    )
    bpy.context.view_layer.update()
    return ob


def add_camera(location, target=(0, 0, 0), **settings: object) -> bpy.types.Object:
    """Adds a camera and makes it the scene's camera."""
    data = bpy.data.cameras.new("Camera")
    for name, value in settings.items():
        setattr(data, name, value)
    ob = bpy.data.objects.new("Camera", data)
    ob.location = location
    towards = Vector(target) - Vector(location)
    ob.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(ob)
    bpy.context.scene.camera = ob
    bpy.context.view_layer.update()
    return ob


def camera_rays(
    ob: bpy.types.Object, st: np.ndarray, size: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray]:
    """Returns origins and directions of rays through places of the camera's frame, as Blender draws
    that frame.
    """
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = size
    frame = np.array(ob.data.view_frame(scene=bpy.context.scene))
    right_top, _, left_bottom, left_top = frame
    s, t = np.asarray(st, np.float64).T[:, :, None]
    local = left_bottom + s * (right_top - left_top) + t * (left_top - left_bottom)
    matrix = np.array(ob.matrix_world.normalized(), np.float64)
    points = local @ matrix[:3, :3].T + matrix[:3, 3]
    if ob.data.type == "ORTHO":
        return points, np.broadcast_to(-matrix[:3, 2], points.shape)
    return np.broadcast_to(matrix[:3, 3], points.shape), points - matrix[:3, 3]


def pixels(image: bpy.types.Image) -> np.ndarray:
    """Returns pixels (height, width, 4) as in Blender's buffer."""
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], image.channels or 4)


def sampled(values: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Interpolates linearly between the four nearest pixels."""
    height, width = values.shape[:2]
    place = uv * [width, height] - 0.5
    first = np.floor(place).astype(int)
    (along_x, along_y), (x, y) = (place - first).T[:, :, None], first.T
    clip_x, clip_y = (lambda i: i.clip(0, width - 1)), (lambda i: i.clip(0, height - 1))
    rows = [
        values[clip_y(j), clip_x(x)] * (1 - along_x) + values[clip_y(j), clip_x(x + 1)] * along_x
        for j in (y, y + 1)
    ]
    return rows[0] * (1 - along_y) + rows[1] * along_y


def image_of_places(size: tuple[int, int] = (64, 64)) -> bpy.types.Image:
    """Makes an image whose red is s and whose green is t. They are linear between pixels, so any
    lookup returns its own place.
    """
    image = bpy.data.images.new("Places", *size, alpha=True, float_buffer=True, is_data=True)
    t, s = (np.mgrid[: size[1], : size[0]] + 0.5) / np.array(size[::-1])[:, None, None]
    values = np.stack([s, t, 0 * s + 0.25, 0 * s + 1], axis=-1)
    image.pixels.foreach_set(values.astype(np.float32).ravel())
    return image
