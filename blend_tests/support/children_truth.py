# SPDX-License-Identifier: GPL-3.0-or-later
"""Where children of guides have to be: by numpy, on the surface as it is in this frame."""

import bpy
import limitsurf
import numpy as np
import scenes
from limit_surface import ids
from limit_surface.nodes import children as nodes
from limit_surface.nodes import groups
from limit_surface.reading import attributes


def table_of(live: bpy.types.Object) -> bpy.types.Object:
    (modifier,) = groups.modifiers(live, ids.CHILDREN_GROUP)
    return groups.get_input(modifier, nodes.TABLE)


def set_input(live: bpy.types.Object, name: str, value: object) -> None:
    (modifier,) = groups.modifiers(live, ids.CHILDREN_GROUP)
    groups.set_input(modifier, name, value)


def stored(live: bpy.types.Object) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Returns faces, uv, guides (n, 4) and weights (n, 4) of live children."""
    data = table_of(live).data
    place = attributes.read(data, "position").astype(np.float64)
    guide = np.stack([attributes.read(data, name) for name in nodes.GUIDE], axis=1)
    weight = attributes.read(data, nodes.WEIGHTS).astype(np.float64)
    weight = np.column_stack([weight, 1 - weight.sum(axis=1)])
    return place[:, 2].astype(int), place[:, :2], guide, weight


def shown_strands(ob: bpy.types.Object) -> np.ndarray:
    """Returns the points (n, k, 3) of children as Blender evaluates them; (0, 0, 3) for none."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    data = ob.evaluated_get(depsgraph).data
    if not len(data.curves):
        return np.zeros((0, 0, 3))
    points = attributes.read(data, "position").astype(np.float64)
    return points.reshape(len(data.curves), -1, 3)


def expected(
    live: bpy.types.Object,
    guides: bpy.types.Object,
    ob: bpy.types.Object,
    surface: limitsurf.LimitSurface | None = None,
) -> np.ndarray:
    """Returns the strands of live children in their own space. They are shaped in the world. Where
    the guides' points are not at equal distances, or are not as many as the children's, they are
    spread evenly along the guides.
    """
    face, uv, guide, weight = stored(live)
    surface = surface or scenes.surface_without_addon(ob)
    in_world = np.array(ob.matrix_world, np.float64)
    root = scenes.transformed(in_world, surface.evaluate(face, uv).position)
    normal = surface.frames(face, uv)[:, :, 2]
    of_guides = surface.frames(*scenes.locations(guides.data))[:, :, 2]
    inverse = np.linalg.inv(in_world[:3, :3])
    normal, of_guides = _unit(normal @ inverse), _unit(of_guides @ inverse)
    count = shown_strands(live).shape[1]
    strands = np.stack([_evenly(each, count) for each in _shown_in_world(guides)])
    offsets = strands - strands[:, :1]
    lengths = _lengths(offsets)
    shape, length = np.zeros((len(face), *strands.shape[1:])), np.zeros(len(face))
    for k in range(guide.shape[1]):
        turn = _turns(of_guides[guide[:, k]], normal)
        turned = np.einsum("nij,npj->npi", turn, offsets[guide[:, k]])
        shape += weight[:, k, None, None] * turned
        length += weight[:, k] * lengths[guide[:, k]]
    shape *= (length / _lengths(shape))[:, None, None]
    back = np.linalg.inv(np.array(live.matrix_world, np.float64))
    return scenes.transformed(back, root[:, None] + shape)


def _shown_in_world(hair: bpy.types.Object) -> list[np.ndarray]:
    data = hair.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    points = attributes.read(data, "position").astype(np.float64)
    points = scenes.transformed(np.array(hair.matrix_world, np.float64), points)
    return np.split(points, attributes.curve_offsets(data)[1:-1])


def _evenly(points: np.ndarray, count: int) -> np.ndarray:
    """Returns so many points at equal distances along a polyline."""
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.linspace(0, along[-1], count)
    return np.stack([np.interp(at, along, each) for each in points.T], axis=1)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _lengths(strands: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.diff(strands, axis=1), axis=2).sum(axis=1)


def _turns(source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Returns the smallest rotations (n, 3, 3) from unit vectors to others, by Rodrigues' formula:
    1 + [v] + [v]^2 / (1 + c) with v their cross product and c their dot product.
    """
    v, c = np.cross(source, target), np.einsum("ni,ni->n", source, target)
    cross = np.cross(v[:, None], np.eye(3)).swapaxes(1, 2)  # its columns are v x axis
    return np.eye(3) + cross + cross @ cross / (1 + c)[:, None, None]
