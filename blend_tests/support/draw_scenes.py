# SPDX-License-Identifier: GPL-3.0-or-later
"""Strokes for the tests of drawing, and where the curves are that were made of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import limitsurf
import numpy as np
import scenes


@dataclass(frozen=True)
class Given:
    """A stroke that is passed to the operator."""

    face: Sequence[int]
    uv: Sequence[tuple[float, float]]
    radius: Sequence[float] = ()
    is_closed: bool = False


def points(*strokes: Given) -> list[dict[str, object]]:
    return [
        {
            "name": "",
            "face": face,
            "uv": uv,
            "radius": stroke.radius[i] if stroke.radius else 1.0,
            "is_first": i == 0,
            "is_closed": stroke.is_closed,
        }
        for stroke in strokes
        for i, (face, uv) in enumerate(zip(stroke.face, stroke.uv, strict=True))
    ]


def surface_in_world(ob: bpy.types.Object) -> limitsurf.LimitSurface:
    """Returns the surface of the cage in world space, made without the extension."""
    surface = scenes.surface_without_addon(ob)
    matrix = np.array(ob.matrix_world, np.float64)
    surface.set_positions(scenes.transformed(matrix, surface.positions))
    return surface


def samples(ob: bpy.types.Object) -> np.ndarray:
    """Returns points all over the surface in the world."""
    surface = surface_in_world(ob)
    u = np.linspace(0, 1, 9)
    uv = np.stack(np.meshgrid(u, u), axis=-1).reshape(-1, 2)
    face = np.repeat(np.arange(surface.face_count), len(uv))
    return surface.evaluate(face, np.tile(uv, (surface.face_count, 1))).position


def distance_from(ob: bpy.types.Object, where: np.ndarray) -> np.ndarray:
    return surface_in_world(ob).closest(where).distance


def world_places(ob: bpy.types.Object, given: Given, offset: float = 0.0) -> np.ndarray:
    """Returns the points of a stroke in the world, at a distance along the outward normal."""
    uv = np.array(given.uv, np.float32).astype(np.float64)
    on = surface_in_world(ob).evaluate(given.face, uv, derivatives=1)
    is_mirrored = ob.matrix_world.determinant() < 0
    return on.position + (-offset if is_mirrored else offset) * on.normal


def control_points(spline: bpy.types.Spline) -> np.ndarray:
    points = spline.bezier_points if spline.type == "BEZIER" else spline.points
    return np.array([point.co[:3] for point in points], np.float32)


def world_points(ob: bpy.types.Object, number: int) -> np.ndarray:
    """Returns dense points along the curve as Blender draws it, without its thickness."""
    data = ob.data.copy()
    data.bevel_depth = 0
    for i in reversed(range(len(data.splines))):
        if i != number:
            data.splines.remove(data.splines[i])
    copy = bpy.data.objects.new("Copy", data)
    copy.matrix_world = ob.matrix_world
    mesh = copy.to_mesh()
    found = np.array([vertex.co for vertex in mesh.vertices], np.float64)
    if data.splines[0].use_cyclic_u:
        found = np.concatenate([found, found[:1]])
    copy.to_mesh_clear()
    bpy.data.objects.remove(copy)
    bpy.data.curves.remove(data)
    t = np.linspace(0, 1, 20, endpoint=False)[None, :, None]
    dense = ((1 - t) * found[:-1, None] + t * found[1:, None]).reshape(-1, 3)
    dense = np.concatenate([dense, found[-1:]])
    return scenes.transformed(np.array(ob.matrix_world, np.float64), dense)


def evaluated_points(ob: bpy.types.Object) -> np.ndarray:
    """Returns the points that are shown, after modifiers, in the object's space."""
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    if ob.type == "CURVES":
        return np.array([point.position for point in evaluated.data.points], np.float64)
    mesh = evaluated.to_mesh()
    found = np.array([vertex.co for vertex in mesh.vertices], np.float64)
    evaluated.to_mesh_clear()
    return found


def distance_from_polyline(where: np.ndarray, line: np.ndarray) -> np.ndarray:
    a, along = line[:-1], np.diff(line, axis=0)
    squared = np.maximum(np.einsum("ij,ij->i", along, along), 1e-300)
    nearest = np.empty(len(where))
    for begin in range(0, len(where), 200):
        arm = where[begin : begin + 200, None] - a
        t = np.clip(np.einsum("nij,ij->ni", arm, along) / squared, 0, 1)
        apart = np.linalg.norm(arm - t[..., None] * along, axis=2)
        nearest[begin : begin + 200] = apart.min(axis=1)
    return nearest
