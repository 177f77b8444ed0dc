# SPDX-License-Identifier: GPL-3.0-or-later
"""Where things have to be that follow a surface: by `limitsurf`, on the control mesh that Blender
evaluates without the extension.
"""

from typing import NamedTuple

import bpy
import limitsurf
import numpy as np
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from mathutils import Matrix

#: Positions in single precision, as a share of the diagonal of the surface's bounding box
POSITION_BOUND = 2e-6
#: Frames, as the largest difference of an entry of their matrices
FRAME_BOUND = 1e-4


class Frames(NamedTuple):
    position: np.ndarray  # (n, 3)
    frame: np.ndarray  # (n, 3, 3): columns tangent, normal x tangent, normal


class AtRest(NamedTuple):
    """Strands before they are bound, and where the surface is then: nothing of it is what the
    extension has stored about the rest.
    """

    points: np.ndarray  # (strands, points, 3)
    frames: Frames

    @classmethod
    def read(cls, ob: bpy.types.Object, hair: bpy.types.Object) -> "AtRest":
        """Reads hair whose roots are on the surface, and makes sure that they are."""
        points = scenes.strands(hair).astype(np.float64)
        frames = on_surface(ob, hair.data, relation(ob, hair))
        error = np.abs(points[:, 0] - frames.position).max()
        assert error < POSITION_BOUND * diagonal(ob)
        return cls(points, frames)

    def carried(self, now: Frames) -> np.ndarray:
        """Returns where the points go when their roots go to these frames."""
        return carried(self.points, self.frames, now)

    def check(self, ob: bpy.types.Object, hair: bpy.types.Object) -> None:
        """Compares the hair as it is shown with where it has to be in this frame."""
        now = on_surface(ob, hair.data, relation(ob, hair))
        error = np.abs(shown_strands(hair) - self.carried(now)).max()
        assert error < POSITION_BOUND * diagonal(ob)


def animate(ob: bpy.types.Object) -> None:
    """Adds a shape key that bends the mesh from frame 1 to 30, and a wave."""
    positions = attributes.read(ob.data, ids.POSITION)
    bent = positions * [1.2, 1, 1]
    bent[:, 2] += np.sin(positions[:, 1])
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Bent")
    key.data.foreach_set("co", bent.astype(np.float32).ravel())
    for frame, value in ((1, 0.0), (30, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    wave = ob.modifiers.new("Wave", "WAVE")
    wave.height = 0.1
    scene = bpy.context.scene
    scene.frame_set(scene.frame_current)  # until now the value of the last key is shown


def diagonal(ob: bpy.types.Object) -> float:
    return float(np.linalg.norm(np.ptp(attributes.read(ob.data, ids.POSITION), axis=0)))


def on_surface(
    ob: bpy.types.Object,
    data: bpy.types.ID,
    matrix: np.ndarray | None = None,
    surface: limitsurf.LimitSurface | None = None,
) -> Frames:
    """Returns the frames at the locations that `data` stores, on the surface as it is now, in the
    space that the matrix leads to.
    """
    subsurf = next((m for m in ob.modifiers if m.type == "SUBSURF"), None)
    boundary = subsurf.boundary_smooth if subsurf else "ALL"
    surface = surface or scenes.surface_without_addon(ob, boundary)
    return frames_at(surface, *scenes.locations(data), np.eye(4) if matrix is None else matrix)


def frames_at(
    surface: limitsurf.LimitSurface, face: np.ndarray, uv: np.ndarray, matrix: np.ndarray
) -> Frames:
    """Returns the frames at locations, in the space that the matrix leads to."""
    position, local = surface.evaluate(face, uv).position, surface.frames(face, uv)
    linear = matrix[:3, :3]
    tangent = _unit(local[:, :, 0] @ linear.T)
    normal = _unit(local[:, :, 2] @ np.linalg.inv(linear))
    frame = np.stack([tangent, np.cross(normal, tangent), normal], axis=2)
    return Frames(scenes.transformed(matrix, position), frame)


def quaternions(frame: np.ndarray) -> np.ndarray:
    """Returns rotation matrices (n, 3, 3) as quaternions, w x y z, by Blender's own conversion."""
    return np.array([Matrix(matrix).to_quaternion() for matrix in frame])


def rest(data: bpy.types.ID) -> Frames:
    root = attributes.read(data, ids.REST_ROOT).astype(np.float64)
    return Frames(root, matrices(attributes.read(data, ids.REST_ROTATION)))


def matrices(quaternions: np.ndarray) -> np.ndarray:
    """Returns unit quaternions (n, 4), w x y z, as matrices (n, 3, 3)."""
    w, x, y, z = quaternions.astype(np.float64).T
    entries = [
        *(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        *(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        *(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    ]
    return np.stack(entries, axis=1).reshape(-1, 3, 3)


def moved(points: np.ndarray, data: bpy.types.ID, now: Frames) -> np.ndarray:
    """Returns points (n, k, 3), k of each location, carried from their rest to the frames."""
    return carried(points, rest(data), now)


def carried(points: np.ndarray, before: Frames, now: Frames) -> np.ndarray:
    local = np.einsum("nji,nkj->nki", before.frame, points - before.position[:, None])
    return now.position[:, None] + np.einsum("nij,nkj->nki", now.frame, local)


def relation(ob: bpy.types.Object, thing: bpy.types.Object) -> np.ndarray:
    """Returns the matrix from the surface's space to that of the thing."""
    return np.linalg.inv(np.array(thing.matrix_world)) @ np.array(ob.matrix_world)


def shown(ob: bpy.types.Object, name: str) -> np.ndarray:
    """Returns an attribute of the object as Blender evaluates it now."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return attributes.read(ob.evaluated_get(depsgraph).data, name)


def shown_strands(hair: bpy.types.Object) -> np.ndarray:
    return shown(hair, ids.POSITION).reshape(len(hair.data.curves), -1, 3)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
