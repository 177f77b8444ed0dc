# SPDX-License-Identifier: Apache-2.0
"""Exact evaluation of Catmull-Clark limit surfaces, also at and near extraordinary vertices and
open boundaries.

    mesh = limitsurf.ControlMesh.from_faces(positions, faces)
    surface = limitsurf.LimitSurface(mesh)
    here = surface.evaluate(face=[0, 0], uv=[[0, 0], [0.25, 0.5]], derivatives=1)
    here.position, here.du, here.dv, here.normal
"""

from ._limitsurf import (
    ControlMesh,
    EdgeCurves,
    FilteredImage,
    LimitSurface,
    LocationError,
    MeshError,
    PtexLayout,
    StrandPoser,
    SubdividedFaces,
    SurfaceData,
    __version__,
    bilinear,
    blend_over,
    box_sides,
    box_weights,
    child_strands,
    into_shading_frames,
    move_strands,
    out_of_shading_frames,
    resample_strands,
    rotation_matrices,
    shortest_turns,
)
from ._results import (
    AlongCurves,
    BlueNoise,
    Curvature,
    DataEvaluation,
    Evaluation,
    FaceLevels,
    GuideWeights,
    Hits,
    Locations,
    MapDistortion,
    MapLocations,
    Projection,
    PtexTexels,
    RayHits,
    Stencils,
    Tessellation,
    Texels,
    TileQuadtree,
    Tiles,
)

__all__ = [
    "AlongCurves",
    "BlueNoise",
    "ControlMesh",
    "Curvature",
    "DataEvaluation",
    "EdgeCurves",
    "Evaluation",
    "FaceLevels",
    "FilteredImage",
    "GuideWeights",
    "Hits",
    "LimitSurface",
    "LocationError",
    "Locations",
    "MapDistortion",
    "MapLocations",
    "MeshError",
    "Projection",
    "PtexLayout",
    "PtexTexels",
    "RayHits",
    "Stencils",
    "StrandPoser",
    "SubdividedFaces",
    "SurfaceData",
    "Tessellation",
    "Texels",
    "TileQuadtree",
    "Tiles",
    "__version__",
    "bilinear",
    "blend_over",
    "box_sides",
    "box_weights",
    "child_strands",
    "into_shading_frames",
    "move_strands",
    "out_of_shading_frames",
    "resample_strands",
    "rotation_matrices",
    "shortest_turns",
]

for _public in (
    ControlMesh,
    EdgeCurves,
    FilteredImage,
    LimitSurface,
    LocationError,
    MeshError,
    PtexLayout,
    StrandPoser,
    SubdividedFaces,
    SurfaceData,
):
    _public.__module__ = __name__
del _public
