# SPDX-License-Identifier: GPL-3.0-or-later
"""The attributes that store curvature."""

import bpy
import numpy as np

from .. import ids
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
    """Raises RefusalError where these names belong to something else."""
    attributes.check_names(ob, _KINDS, domain)


def write(data: bpy.types.ID, domain: str, values: Values, color: np.ndarray) -> None:
    """Writes the values. Directions that do not exist are zero vectors; numbers that do not exist
    are NaN.
    """
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
    """Writes the values of a mesh's vertices, and shows the colours where attributes are shown."""
    write(mesh, "POINT", values, color)
    mesh.color_attributes.active_color = mesh.color_attributes[ids.CURVATURE_COLOR]
    mesh.update()
