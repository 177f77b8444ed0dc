# SPDX-License-Identifier: GPL-3.0-or-later
"""A 3D view as a projector: the image is as large as fits into the view, in its middle."""

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading.projector import Projector, fitted

NO_VIEW = (
    "There is no 3D view to project from: run the operator in a 3D view, or choose another source"
)


def from_context(context: bpy.types.Context, size: tuple[int, int]) -> Projector:
    """Raises RefusalError where the operator does not run in a 3D view."""
    space, area = context.space_data, context.area
    if space is None or area is None or space.type != "VIEW_3D":
        raise RefusalError(NO_VIEW)
    region, view = context.region, context.region_data
    # this may be the sidebar's region, for example
    if region is None or region.type != "WINDOW" or view is None:
        region, view = next(r for r in area.regions if r.type == "WINDOW"), space.region_3d
    return projector(view, (region.width, region.height), size)


def projector(
    view: bpy.types.RegionView3D, region: tuple[int, int], size: tuple[int, int]
) -> Projector:
    matrix = np.array(view.perspective_matrix, np.float64)
    if min(region) < 1 or not np.linalg.matrix_rank(matrix) == 4:
        raise RefusalError(
            "The 3D view has not been drawn yet, so nothing can be projected "
            "from it: run the operator again"
        )
    filled = fitted(size) / fitted(region)
    scale = np.array([*(filled.max() / filled), 1, 1])
    return Projector("The view", scale[:, None] * matrix, has_eye=view.is_perspective)
