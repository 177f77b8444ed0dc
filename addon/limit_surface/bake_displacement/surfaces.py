# SPDX-License-Identifier: GPL-3.0-or-later
"""The two surfaces, in the space of the object that is displaced."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import ids, native
from ..errors import MultiresolutionError, RefusalError
from ..images import texel_places
from ..reading import attributes, cage, transform
from ..reading.named import find_object
from ..tasks.object_keys import ObjectKey
from ..tasks.refused_faces import check_some_left

if TYPE_CHECKING:
    import limitsurf


@dataclass(frozen=True)
class Surfaces:
    base: limitsurf.LimitSurface
    sculpted: limitsurf.LimitSurface
    uv_data: limitsurf.SurfaceData | None  # the UV map of the base, where one is needed
    found: cage.Cage  # the cage of the base
    target: ObjectKey


def read(
    properties: bpy.types.OperatorProperties, context: bpy.types.Context, ob: bpy.types.Object
) -> Surfaces:
    """Raises RefusalError where there are not two surfaces."""
    depsgraph = context.evaluated_depsgraph_get()
    target = _target(properties.target, context, ob)
    in_tangent_space = properties.mode == "VECTOR" and properties.space == "TANGENT"
    needs_map = properties.layout_kind == "UV" or in_tangent_space
    if properties.layout_kind == "PTEX" and needs_map and not ob.data.uv_layers:
        raise RefusalError(f"{ob.name}: tangent space needs a UV map: choose the space Object")
    if needs_map:
        found = texel_places.read_cage(ob, depsgraph, properties.uv_map)
    else:
        found = cage.read(ob, depsgraph)
    base = _surface(found.mesh, ob.name)
    uv_data = texel_places.uv_data(base, found, ob.name) if needs_map else None
    if properties.target_shape == "LIMIT":
        try:
            found_target = cage.read(target, depsgraph)
        except MultiresolutionError as error:
            # Applied, it leaves polygons on the limit surface, which must not be smoothed again.
            raise RefusalError(
                f"{target.name} has a Multiresolution modifier: set Sculpted Surface to Polygons"
            ) from error
        mesh, matrix = found_target.mesh, found_target.matrix
    else:
        mesh, matrix = _polygons(target, depsgraph)
    sculpted = _surface(mesh, target.name)
    if properties.transform == "WORLD":
        sculpted.set_positions(_carried(mesh.positions, matrix, found.matrix, ob.name))
    return Surfaces(base, sculpted, uv_data, found, ObjectKey.of(target))


def _target(name: str, context: bpy.types.Context, ob: bpy.types.Object) -> bpy.types.Object:
    if name:
        target = find_object(name, "the sculpted mesh")
    else:
        others = [o for o in context.selected_objects if o != ob and o.type == "MESH"]
        if len(others) != 1:
            raise RefusalError(
                f"{len(others) or 'No'} other mesh{'es are' if len(others) > 1 else ' is'} "
                f"selected: select {ob.name} and one sculpted mesh"
            )
        target = others[0]
    if target == ob:
        raise RefusalError(f"{ob.name} is chosen as its own sculpted mesh")
    if target.type != "MESH":
        raise RefusalError(f"{target.name} is not a mesh")
    return target


def _polygons(
    target: bpy.types.Object, depsgraph: bpy.types.Depsgraph
) -> tuple[limitsurf.ControlMesh, np.ndarray]:
    """Returns the polygons as the viewport shows them; a place between vertices lies on a bilinear
    patch.
    """
    evaluated = target.evaluated_get(depsgraph)
    if not evaluated.is_evaluated:  # so this would be the mesh without its modifiers
        raise RefusalError(
            f"{target.name} is disabled in viewports or is not in this view layer, so the "
            "viewport shows no polygons of it: enable it, or set Sculpted Surface to Limit"
        )
    mesh = evaluated.data
    if not mesh.polygons:
        raise RefusalError(f"{target.name} has no faces")
    polygons = native.limitsurf.ControlMesh(
        attributes.read(mesh, ids.POSITION).astype(np.float64),
        attributes.face_sizes(mesh),
        attributes.read(mesh, ids.CORNER_VERTEX),
        scheme="bilinear",
    )
    matrix = np.array(evaluated.matrix_world, np.float64)
    transform.check_finite(matrix, target.name)
    return polygons, matrix


def _surface(mesh: limitsurf.ControlMesh, name: str) -> limitsurf.LimitSurface:
    surface = native.limitsurf.LimitSurface(mesh)
    check_some_left(surface, name)
    return surface


def _carried(
    positions: np.ndarray, matrix: np.ndarray, base_matrix: np.ndarray, base_name: str
) -> np.ndarray:
    """Returns the positions carried from one object's space to another's, by way of the world."""
    relative = transform.relation(base_matrix, matrix, base_name)
    return positions @ relative[:3, :3].T + relative[:3, 3]
