# SPDX-License-Identifier: GPL-3.0-or-later
"""The attributes that hold curvature."""

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..reading import attributes
from .values import Values

_KINDS = {
    ids.CURVATURE_MEAN: "FLOAT",
    ids.CURVATURE_GAUSSIAN: "FLOAT",
    ids.CURVATURE_K1: "FLOAT",
    ids.CURVATURE_K2: "FLOAT",
    ids.CURVATURE_DIRECTION1: "FLOAT_VECTOR",
    ids.CURVATURE_DIRECTION2: "FLOAT_VECTOR",
    ids.CURVATURE_IRREGULAR: "BOOLEAN",
    ids.CURVATURE_COLOR: "FLOAT_COLOR",
}


def check(ob: bpy.types.Object, domain: str) -> None:
    """RefusalError where something else has these names."""
    data = ob.data
    for name, kind in _KINDS.items():
        there = data.attributes.get(name)
        if there and (there.data_type, there.domain) != (kind, domain):
            raise RefusalError(
                f"{data.name} has an attribute {name} of another kind "
                f"({there.data_type} on {there.domain}): rename or remove it"
            )
        if name in ob.vertex_groups:  # they share names with attributes
            raise RefusalError(f"{ob.name} has a vertex group {name}: rename or remove it")


def write(data: bpy.types.ID, domain: str, values: Values, color: np.ndarray) -> None:
    """Directions that do not exist are zero vectors; numbers that do not are NaN."""
    stored = (
        values.mean,
        values.gaussian,
        values.k1,
        values.k2,
        np.nan_to_num(values.direction1),
        np.nan_to_num(values.direction2),
        values.irregular,
        color,
    )
    for (name, kind), of in zip(_KINDS.items(), stored, strict=True):
        attributes.write(data, name, kind, domain, of)


def write_on_mesh(mesh: bpy.types.Mesh, values: Values, color: np.ndarray) -> None:
    """Of its vertices; and shows the colours where attributes are shown."""
    write(mesh, "POINT", values, color)
    mesh.color_attributes.active_color = mesh.color_attributes[ids.CURVATURE_COLOR]
    mesh.update()
