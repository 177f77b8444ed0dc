# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points from elsewhere: they are bound at their closest points on a surface, and keep
their distance from it. Nothing moves. The same holds for things whose modifier of following was
applied, which keep their places.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import bpy
import numpy as np

from .. import ids, native
from ..errors import RefusalError
from ..reading import cage
from ..tasks.piecewise_job import Pieces, aside
from ..tasks.refused_faces import check_some_left
from . import following
from .added_vertices import AddedVertices
from .applied_shapes import rows_as_posed
from .followers import is_stray
from .posed_surface import Places as PosedPlaces
from .posed_surface import PosedSurface, at_closest
from .relocation import Elements, Relocation

_DEFORMERS = {"ARMATURE", "CURVE", "HOOK", "LATTICE", "MESH_DEFORM", "SURFACE_DEFORM"}
_DEFORM_NODE = "GeometryNodeDeformCurvesOnSurface"


def relocations(
    things: Sequence[bpy.types.Object],
    surface: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
) -> Pieces:
    """Returns the places (list[Relocation]) of those strands and points that have none yet, and new
    places at rest for things whose modifier of following was applied. Raises RefusalError where
    the others were bound before the faces of the surface changed.
    """
    waiting: dict[bpy.types.ID, Elements] = {}
    for ob in things:
        elements = Elements(ob)
        if not elements.has_place.all() or is_stray(ob):
            waiting.setdefault(ob.data, elements)
    if not waiting:
        return []
    posed = PosedSurface(cage.read(surface, depsgraph))
    check_some_left(posed.in_world, surface.name)
    found = []
    for elements in waiting.values():
        if elements.has_place.any():
            following.check_holds(elements.ob, surface, following.signature(posed.cage))
            elements.places.check(posed.in_object.face_count, surface.name)
        relocation = Relocation(elements)
        rows = np.flatnonzero(~elements.has_place)
        if len(rows):
            added, points = AddedVertices(elements, posed), elements.first_points()
            added.put_into(points)
            relocation = yield from bound_at_closest(elements, posed, rows, points=points)
            added.put_back(relocation)
        if is_stray(elements.ob):
            yield from _leave_as_posed(relocation, posed)
        if relocation.values:
            found.append(relocation)
    return found


def _leave_as_posed(relocation: Relocation, posed: PosedSurface) -> Pieces:
    """Makes the shape that the surface gives elements in this frame their shape at rest, if it is
    theirs.
    """
    elements = relocation.elements
    rows = yield from rows_as_posed(elements, posed)
    if len(rows):
        face, uv = elements.read(ids.FACE)[rows], elements.read(ids.UV)[rows]
        yield from put_places(relocation, posed, rows, face, uv)


def bound_at_closest(
    elements: Elements,
    posed: PosedSurface,
    rows: np.ndarray,
    max_distance: float = math.inf,
    points: np.ndarray | None = None,
) -> Pieces:
    """Binds some elements where they are, and returns the Relocation. Those beyond the distance
    (world units) are lost. `points` are the first points of all elements, in the world, where they
    are not those of `elements`.
    """
    points = (elements.first_points() if points is None else points)[rows]
    lost_row = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(lost_row):
        raise RefusalError(
            f"{elements.called(rows[lost_row[0]])} has a coordinate that is not a finite number"
        )
    hits = yield from aside(
        lambda progress: posed.in_world.closest(points, max_distance, progress=progress)
    )
    found = hits.face >= 0
    relocation = Relocation(elements, lost=rows[~found], distances=np.zeros(int(found.sum())))
    at = at_closest(posed, hits)
    yield from put_places(relocation, posed, rows[found], at.face[found], at.uv[found])
    return relocation


def put_places(
    relocation: Relocation,
    posed: PosedSurface,
    rows: np.ndarray,
    face: np.ndarray,
    uv: np.ndarray,
) -> Pieces:
    """Stores locations and the roots at rest there, and returns the frames (n, 3, 3) there."""
    rounded = uv.astype(np.float32)
    matrix = relocation.elements.matrix
    places, turn = yield from aside(lambda _progress: _turned(posed, face, rounded, matrix))
    relocation.put(ids.FACE, rows, face)
    relocation.put(ids.UV, rows, rounded)
    relocation.put(ids.REST_ROOT, rows, places.position)
    relocation.put(ids.REST_ROTATION, rows, turn)
    return places.frame


def _turned(
    posed: PosedSurface, face: np.ndarray, uv: np.ndarray, matrix: np.ndarray
) -> tuple[PosedPlaces, np.ndarray]:
    places = posed.places(face, uv.astype(np.float64), matrix)
    return places, native.limitsurf.quaternions(places.frame)


def disable_deformation_by_blender(ob: bpy.types.Object) -> list[str]:
    """Disables the modifiers by which Blender itself makes hair follow its surface, because hair
    would be moved twice, and returns their names.
    """
    names = []
    for modifier in ob.modifiers:
        is_enabled = modifier.show_viewport or modifier.show_render
        if is_enabled and modifier.type == "NODES" and _deforms(modifier.node_group):
            modifier.show_viewport = modifier.show_render = False
            names.append(modifier.name)
    return names


def other_deformers(ob: bpy.types.Object) -> list[str]:
    """Returns the names of a mesh's enabled modifiers that may move it together with the surface,
    so that its vertices would be moved twice.
    """
    return [
        modifier.name
        for modifier in ob.modifiers
        if modifier.type in _DEFORMERS and (modifier.show_viewport or modifier.show_render)
    ]


def _deforms(group: bpy.types.NodeTree | None) -> bool:
    nodes = group.nodes if group else ()
    return any(
        node.bl_idname == _DEFORM_NODE
        or (node.bl_idname == "GeometryNodeGroup" and _deforms(node.node_tree))
        for node in nodes
    )
