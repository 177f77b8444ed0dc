# SPDX-License-Identifier: GPL-3.0-or-later
"""The truth for snapping: dense samples of the surface, refined in ever smaller steps.

Of limitsurf only evaluation is used here.
"""

import bpy
import numpy as np
import pytest
import scenes

SIDE = 17  # samples along each side of a face
# number of starts of the refinement for each point: the closest samples of so many faces
STARTS = 6


class Truth:
    """The limit surface of an object in world space."""

    def __init__(self, ob: bpy.types.Object, boundary: str = "ALL") -> None:
        bpy.context.view_layer.update()
        self.surface = scenes.surface_without_addon(ob, boundary)
        self.matrix = np.array(ob.matrix_world, np.float64)
        side = np.linspace(0, 1, SIDE)
        grid = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
        self._faces = self.surface.face_count
        self._face = np.repeat(np.arange(self._faces), len(grid))
        self._uv = np.tile(grid, (self._faces, 1))
        self.samples = self.positions(self._face, self._uv)

    def positions(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        return scenes.transformed(self.matrix, self.surface.evaluate(face, uv).position)

    def normals(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Returns normals that point outward as Blender shows them: those of a mirrored object
        point the same way.
        """
        local = self.surface.frames(face, uv)[:, :, 2]
        world = np.linalg.solve(self.matrix[:3, :3].T, local.T).T
        return world / np.linalg.norm(world, axis=1, keepdims=True)

    def distances(self, points: np.ndarray) -> np.ndarray:
        return np.array([self.closest(point)[2] for point in np.reshape(points, (-1, 3))])

    def closest(self, point: np.ndarray) -> tuple[int, np.ndarray, float]:
        """Returns the face, (u, v) and distance."""
        squared = ((self.samples - point) ** 2).sum(axis=1).reshape(self._faces, -1)
        face = np.argsort(squared.min(axis=1))[:STARTS]
        uv = self._uv[: SIDE**2][squared[face].argmin(axis=1)]
        reach = 1 / (SIDE - 1)
        steps = np.stack(np.meshgrid(*2 * [np.linspace(-1, 1, 5)]), axis=-1).reshape(-1, 2)
        while reach > 1e-9:
            tried = np.clip(uv[:, None] + reach * steps, 0, 1)
            positions = self.positions(np.repeat(face, len(steps)), tried.reshape(-1, 2))
            off = np.linalg.norm(positions - point, axis=1).reshape(tried.shape[:2])
            best = tried[np.arange(len(face)), off.argmin(axis=1)]
            # otherwise steps of the same size may bring the point closer
            if np.array_equal(best, uv):
                reach *= 0.5
            uv = best
        closest = off.min(axis=1).argmin()
        return int(face[closest]), uv[closest], float(off.min())

    def normals_at(self, points: np.ndarray) -> np.ndarray:
        """Returns the normals of the closest points."""
        found = [self.closest(point) for point in points]
        return self.normals(
            np.array([f for f, _, _ in found]), np.array([uv for _, uv, _ in found])
        )


def stretched(ob: bpy.types.Object) -> bpy.types.Object:
    """Rotates an object and scales it differently along each axis."""
    ob.location, ob.rotation_euler, ob.scale = (1, -2, 3), (0.4, 0.5, 0.6), (2, 0.7, 1.3)
    bpy.context.view_layer.update()
    return ob


def mirrored(ob: bpy.types.Object) -> bpy.types.Object:
    stretched(ob).scale[0] *= -1
    bpy.context.view_layer.update()
    return ob


def near(ob: bpy.types.Object, count: int, spread: float, seed: int = 0) -> np.ndarray:
    """Returns random points around an object's vertices, in world space."""
    rng = np.random.default_rng(seed)
    vertices = np.array([vertex.co for vertex in ob.data.vertices])
    chosen = vertices[rng.integers(len(vertices), size=count)]
    return scenes.transformed(ob.matrix_world, chosen) + spread * rng.normal(size=(count, 3))


def add_object(
    location: np.ndarray, data: bpy.types.ID | None = None, name: str = "Thing"
) -> bpy.types.Object:
    """Adds an object that is selected and not active."""
    ob = bpy.data.objects.new(name, data)
    ob.location = location
    bpy.context.collection.objects.link(ob)
    ob.select_set(True)
    return ob


def snap(ob: bpy.types.Object, **properties: object) -> None:
    """Snaps to an object, in Object Mode."""
    scenes.activate(ob)
    bpy.context.view_layer.update()
    assert bpy.ops.object.limit_snap(**properties) == {"FINISHED"}


def world_locations(objects: list[bpy.types.Object]) -> np.ndarray:
    bpy.context.view_layer.update()
    return np.array([ob.matrix_world.translation for ob in objects], np.float64)


def refused_and_unchanged(
    target: bpy.types.Object, thing: bpy.types.Object, match: str, **properties: object
) -> None:
    scenes.activate(target)
    bpy.context.view_layer.update()
    before = thing.matrix_world.copy(), thing.matrix_basis.copy()
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_snap(**properties)
    bpy.context.view_layer.update()
    assert (thing.matrix_world, thing.matrix_basis) == before
