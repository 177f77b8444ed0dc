# SPDX-License-Identifier: GPL-3.0-or-later
"""An evaluated object as numpy arrays, for programs that read neither Alembic nor USD."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..reading import attributes

TYPES = frozenset({"MESH", "CURVES", "POINTCLOUD"})

# attributes that are written where an object has them
_CARRIED = (
    "radius",
    ids.FACE,
    ids.UV,
    ids.NORMAL,
    ids.TANGENT,
    ids.ROTATION,
    ids.SCALE,
    ids.MEMBER,
)


def write(path: Path, ob: bpy.types.Object) -> bool:
    """Writes the object as the viewport shows it, and tells whether it has any points. Positions
    are in the object's space.

    The same arrays give the same bytes: numpy writes no date.
    """
    evaluated = _evaluated(ob)
    if not evaluated.is_evaluated:  # so this would be the object without its modifiers
        raise RefusalError(f"Blender does not evaluate {ob.name} in this frame")
    np.savez(path, **_arrays(evaluated))
    return not is_empty(evaluated)


def is_empty(evaluated: bpy.types.Object) -> bool:
    """Tells whether an evaluated object has no points, of which arrays could be made."""
    position = evaluated.data.attributes.get(ids.POSITION)
    return position is None or not len(position.data)


def _evaluated(ob: bpy.types.Object) -> bpy.types.Object:
    return ob.evaluated_get(bpy.context.evaluated_depsgraph_get())


def _positions(data: bpy.types.ID) -> np.ndarray:
    if ids.POSITION not in data.attributes:  # a new mesh without vertices
        return np.empty((0, 3), np.float32)
    return attributes.read(data, ids.POSITION)


def _arrays(evaluated: bpy.types.Object) -> dict[str, np.ndarray]:
    data = evaluated.data
    found = {
        "matrix_world": np.array(evaluated.matrix_world, np.float32),
        ids.POSITION: _positions(data),
    }
    if evaluated.type == "MESH":
        found["face_sizes"] = attributes.face_sizes(data)
        # a mesh without faces need not have the attribute of its corners
        found["face_vertices"] = np.empty(len(data.loops), np.int32)
        data.loops.foreach_get("vertex_index", found["face_vertices"])
    if evaluated.type == "CURVES":
        found["curve_offsets"] = attributes.curve_offsets(data)
    for name in _CARRIED:
        there = data.attributes.get(name)
        if there and there.data_type in attributes.LAYOUTS:  # a user's own may have other types
            found[name] = attributes.read(data, name)
    return found
