# SPDX-License-Identifier: Apache-2.0
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, NoReturn, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ._results import (
    AlongCurves,
    BlueNoise,
    Curvature,
    DataEvaluation,
    Evaluation,
    FaceLevels,
    GuideWeights,
    Hits,
    LaidPaths,
    Locations,
    MapDistortion,
    MapLocations,
    PathFit,
    PlacedFrames,
    Projection,
    PtexTexels,
    RayHits,
    Stencils,
    Tessellation,
    Texels,
    TileQuadtree,
    Tiles,
)

__version__: str

class _BoundType(type): ...  # of all classes that pybind11 binds
class MeshError(ValueError): ...
class LocationError(ValueError): ...

class ControlMesh(metaclass=_BoundType):
    def __init__(
        self,
        positions: ArrayLike,
        face_sizes: ArrayLike,
        face_vertices: ArrayLike,
        edge_sharpness: tuple[ArrayLike, ArrayLike] | None = None,
        vertex_sharpness: tuple[ArrayLike, ArrayLike] | None = None,
        boundary: Literal["smooth", "corners"] = "smooth",
        creasing: Literal["uniform", "chaikin"] = "uniform",
        triangles: Literal["catmark", "smooth"] = "catmark",
        scheme: Literal["catmark", "bilinear"] = "catmark",
        holes: ArrayLike | None = None,
    ) -> None: ...
    @staticmethod
    def from_faces(
        positions: ArrayLike,
        faces: NDArray[np.integer[Any]] | Sequence[ArrayLike],
        edge_sharpness: tuple[ArrayLike, ArrayLike] | None = None,
        vertex_sharpness: tuple[ArrayLike, ArrayLike] | None = None,
        boundary: Literal["smooth", "corners"] = "smooth",
        creasing: Literal["uniform", "chaikin"] = "uniform",
        triangles: Literal["catmark", "smooth"] = "catmark",
        scheme: Literal["catmark", "bilinear"] = "catmark",
        holes: ArrayLike | None = None,
    ) -> ControlMesh: ...
    @property
    def positions(self) -> NDArray[np.float64]: ...
    @property
    def face_sizes(self) -> NDArray[np.int32]: ...
    @property
    def face_vertices(self) -> NDArray[np.int32]: ...
    @property
    def boundary(self) -> Literal["smooth", "corners"]: ...
    @property
    def creasing(self) -> Literal["uniform", "chaikin"]: ...
    @property
    def triangles(self) -> Literal["catmark", "smooth"]: ...
    @property
    def scheme(self) -> Literal["catmark", "bilinear"]: ...
    @property
    def edge_sharpness(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]: ...
    @property
    def vertex_sharpness(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]: ...
    @property
    def holes(self) -> NDArray[np.int64]: ...

class SurfaceData(metaclass=_BoundType):
    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...  # surfaces make them
    @property
    def shape(self) -> tuple[int, int]: ...
    def set_values(self, values: ArrayLike, threads: int = 0) -> None: ...
    def evaluate(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        derivatives: Literal[0, 1, 2] = 0,
        *,
        threads: int = 0,
        dtype: DTypeLike = ...,
    ) -> DataEvaluation: ...
    def bounds(self, side: int = 1, *, threads: int = 0) -> NDArray[np.float64]: ...
    def rasterize(
        self,
        width: int,
        height: int,
        tile: tuple[int, int] = ...,
        margin: float = 0,
        *,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> Texels: ...
    def locate(
        self,
        points: ArrayLike,
        *,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> MapLocations: ...

class FilteredImage(metaclass=_BoundType):
    def __init__(
        self,
        pixels: ArrayLike,
        extension: Literal["clip", "extend", "repeat", "mirror"] = "clip",
        *,
        premultiplied: bool = False,
        threads: int = 0,
    ) -> None: ...
    @property
    def shape(self) -> tuple[int, int, int]: ...
    def sample(
        self,
        st: ArrayLike,
        footprint: ArrayLike,
        *,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> NDArray[np.float32]: ...
    def bounds(self, boxes: ArrayLike, *, threads: int = 0) -> NDArray[np.float32]: ...

def blend_over(
    below: ArrayLike,
    above: ArrayLike,
    weight: ArrayLike,
    mode: Literal["mix", "add", "multiply"] = "mix",
    *,
    premultiplied: bool = False,
) -> NDArray[np.float32]: ...
def box_sides(matrix: ArrayLike) -> NDArray[np.float64]: ...
def box_weights(
    normals: ArrayLike, blend: float = 0.0, matrix: ArrayLike | None = None
) -> NDArray[np.float64]: ...

class SubdividedFaces(metaclass=_BoundType):
    def __init__(self, base: ControlMesh, subdivided: ControlMesh) -> None: ...
    @property
    def levels(self) -> int: ...
    @property
    def order(self) -> Literal["blender", "opensubdiv"]: ...
    def locate(self, face: ArrayLike, uv: ArrayLike, *, threads: int = 0) -> Locations: ...

class EdgeCurves(metaclass=_BoundType):
    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...  # surfaces make them
    def __len__(self) -> int: ...
    @property
    def lengths(self) -> NDArray[np.float64]: ...
    @property
    def closed(self) -> NDArray[np.bool_]: ...
    @property
    def offsets(self) -> NDArray[np.int64]: ...
    @property
    def edges(self) -> NDArray[np.int32]: ...
    @property
    def faces(self) -> NDArray[np.int32]: ...
    @property
    def edge_lengths(self) -> NDArray[np.float64]: ...
    @property
    def left_out(self) -> int: ...
    def at(
        self,
        curve: ArrayLike,
        arc: ArrayLike,
        side: Literal["left", "right"] = "left",
        *,
        threads: int = 0,
    ) -> AlongCurves: ...

class FixedSamples(metaclass=_BoundType):
    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...  # surfaces make them
    def __len__(self) -> int: ...
    @property
    def derivatives(self) -> Literal[0, 1]: ...
    @property
    def vertex_count(self) -> int: ...
    @property
    def nbytes(self) -> int: ...
    def evaluate(
        self, positions: ArrayLike, *, threads: int = 0, dtype: DTypeLike = ...
    ) -> Evaluation: ...

class StrandPoser(metaclass=_BoundType):
    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...  # surfaces make them
    def __len__(self) -> int: ...
    @property
    def bound_count(self) -> int: ...
    @property
    def irregular_count(self) -> int: ...
    @property
    def point_count(self) -> int: ...
    def pose(
        self,
        rest_points: ArrayLike,
        matrix: ArrayLike | None = None,
        out: NDArray[np.float32] | None = None,
        *,
        positions: ArrayLike | None = None,
        threads: int = 0,
    ) -> NDArray[np.float32]: ...
    def repose(
        self,
        rest_points: ArrayLike,
        points: NDArray[np.float32],
        matrix: ArrayLike | None = None,
        *,
        positions: ArrayLike | None = None,
        threads: int = 0,
    ) -> tuple[bool, NDArray[np.int32]]: ...
    def unpose(
        self,
        points: ArrayLike,
        matrix: ArrayLike | None = None,
        out: NDArray[np.float32] | None = None,
        *,
        only: ArrayLike | None = None,
        positions: ArrayLike | None = None,
        threads: int = 0,
    ) -> NDArray[np.float32]: ...
    def pose_vectors(
        self,
        rest_vectors: ArrayLike,
        matrix: ArrayLike | None = None,
        out: NDArray[np.float32] | None = None,
        *,
        positions: ArrayLike | None = None,
        threads: int = 0,
    ) -> NDArray[np.float32]: ...
    def pose_rotations(
        self,
        rest_rotations: ArrayLike,
        matrix: ArrayLike | None = None,
        out: NDArray[np.float32] | None = None,
        *,
        positions: ArrayLike | None = None,
        threads: int = 0,
    ) -> NDArray[np.float32]: ...
    def fingerprints(self, points: ArrayLike, *, threads: int = 0) -> NDArray[np.int32]: ...

class PtexLayout(metaclass=_BoundType):
    def __init__(self, face_count: int, resolution: int) -> None: ...
    @property
    def face_count(self) -> int: ...
    @property
    def resolution(self) -> int: ...
    @property
    def columns(self) -> int: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    def texels(self) -> PtexTexels: ...
    def map_coordinates(self, face: ArrayLike, uv: ArrayLike) -> NDArray[np.float64]: ...

def resample_strands(
    points: ArrayLike, offsets: ArrayLike, count: int, *, threads: int = 0
) -> NDArray[np.float64]: ...
def child_strands(
    guide_points: ArrayLike,
    guide_normals: ArrayLike,
    guide: ArrayLike,
    weight: ArrayLike,
    roots: ArrayLike,
    normals: ArrayLike,
    *,
    threads: int = 0,
    progress: Callable[[float], object] | None = None,
) -> NDArray[np.float32]: ...
def bilinear(pixels: ArrayLike, st: ArrayLike, *, threads: int = 0) -> NDArray[np.float64]: ...

class LimitSurface(metaclass=_BoundType):
    def __init__(self, mesh: ControlMesh) -> None: ...
    @property
    def mesh(self) -> ControlMesh: ...
    @property
    def positions(self) -> NDArray[np.float64]: ...
    @property
    def face_count(self) -> int: ...
    @property
    def base_face(self) -> NDArray[np.int32]: ...
    @property
    def corner(self) -> NDArray[np.int32]: ...
    @property
    def refused(self) -> Mapping[int, str]: ...
    def set_positions(self, positions: ArrayLike, threads: int = 0) -> None: ...
    def evaluate(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        derivatives: Literal[0, 1, 2] = 0,
        *,
        threads: int = 0,
        dtype: DTypeLike = ...,
    ) -> Evaluation: ...
    def frames(
        self, face: ArrayLike, uv: ArrayLike, *, threads: int = 0, dtype: DTypeLike = ...
    ) -> NDArray[np.floating[Any]]: ...
    def placed_frames(
        self, face: ArrayLike, uv: ArrayLike, *, threads: int = 0, dtype: DTypeLike = ...
    ) -> PlacedFrames: ...
    def tangent_frames(
        self,
        uv_map: SurfaceData,
        face: ArrayLike,
        uv: ArrayLike,
        *,
        threads: int = 0,
        dtype: DTypeLike = ...,
    ) -> NDArray[np.floating[Any]]: ...
    def map_distortion(
        self,
        uv_map: SurfaceData,
        face: ArrayLike,
        uv: ArrayLike,
        *,
        threads: int = 0,
        dtype: DTypeLike = ...,
    ) -> MapDistortion: ...
    def curvature(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        *,
        irregular: Literal["none", "average"] = "none",
        radius: float = 1 / 64,
        threads: int = 0,
        dtype: DTypeLike = ...,
    ) -> Curvature: ...
    def stencils(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        derivatives: Literal[0, 1] = 0,
        *,
        threads: int = 0,
    ) -> Stencils: ...
    def tiles(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        max_depth: int | None = None,
        *,
        threads: int = 0,
    ) -> Tiles: ...
    def edge_curves(
        self, edges: Literal["boundary", "creases"] | ArrayLike = "boundary", *, threads: int = 0
    ) -> EdgeCurves: ...
    def scatter_along(
        self,
        curves: EdgeCurves,
        count: int | None = None,
        spacing: float | None = None,
        jitter: float = 0.0,
        seed: int = 0,
        *,
        phase: float | None = None,
        side: Literal["left", "right"] = "left",
        rows: int = 1,
        row_distance: float = 0.0,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> AlongCurves: ...
    def tile_quadtree(
        self,
        max_depth: int | None = None,
        *,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> TileQuadtree: ...
    def fixed_samples(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        derivatives: Literal[0, 1] = 0,
        *,
        threads: int = 0,
    ) -> FixedSamples: ...
    def strand_poser(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        rest_roots: ArrayLike,
        rest_rotations: ArrayLike,
        offsets: ArrayLike | None = None,
        *,
        threads: int = 0,
    ) -> StrandPoser: ...
    def face_varying(
        self,
        values: ArrayLike,
        indices: ArrayLike,
        interpolation: Literal[
            "none", "corners_only", "corners_plus1", "corners_plus2", "boundaries", "all"
        ],
        *,
        threads: int = 0,
    ) -> SurfaceData: ...
    def vertex_data(self, values: ArrayLike, *, threads: int = 0) -> SurfaceData: ...
    def varying(self, values: ArrayLike, *, threads: int = 0) -> SurfaceData: ...
    def vertex_locations(self) -> Locations: ...
    def closest(
        self,
        points: ArrayLike,
        max_distance: float = ...,
        *,
        facing: ArrayLike | None = None,
        max_angle: float = ...,
        threads: int = 0,
        dtype: DTypeLike = ...,
        progress: Callable[[float], object] | None = None,
    ) -> Hits: ...
    def ray_cast(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        max_distance: float = ...,
        *,
        threads: int = 0,
        dtype: DTypeLike = ...,
        progress: Callable[[float], object] | None = None,
    ) -> Hits: ...
    def ray_cast_all(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        max_distance: float = ...,
        *,
        threads: int = 0,
        dtype: DTypeLike = ...,
        progress: Callable[[float], object] | None = None,
    ) -> RayHits: ...
    def curve_directions(
        self,
        points: ArrayLike,
        offsets: ArrayLike | None,
        face: ArrayLike,
        uv: ArrayLike,
        *,
        threads: int = 0,
        dtype: DTypeLike = ...,
        progress: Callable[[float], object] | None = None,
    ) -> NDArray[np.floating[Any]]: ...
    def lay_path(
        self,
        points: ArrayLike,
        tolerance: float,
        *,
        handle_left: ArrayLike | None = None,
        handle_right: ArrayLike | None = None,
        offsets: ArrayLike | None = None,
        closed: bool | ArrayLike = False,
        max_step: float = ...,
        threads: int = 0,
    ) -> LaidPaths: ...
    def fit_path(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        tolerance: float,
        *,
        kind: Literal["bezier", "poly"] = "bezier",
        closed: bool = False,
        offset: float = 0.0,
        corner_angle: float = ...,
        values: ArrayLike | None = None,
        value_tolerance: float = 0.0,
        threads: int = 0,
    ) -> PathFit: ...
    def smooth_path(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        weights: ArrayLike,
        iterations: int = 1,
        *,
        closed: bool = False,
        threads: int = 0,
    ) -> Locations: ...
    def even_path(
        self, face: ArrayLike, uv: ArrayLike, count: int, *, threads: int = 0
    ) -> Locations: ...
    def project(
        self,
        uv_map: SurfaceData,
        face: ArrayLike,
        uv: ArrayLike,
        matrix: ArrayLike,
        texel: tuple[float, float],
        *,
        facing: tuple[float, float] = ...,
        two_sided: bool = False,
        occlusion: bool = True,
        samples: Literal[1, 4, 16] = 1,
        bias: float | None = None,
        soft_edge: float = 0.0,
        frame: bool = True,
        depth: tuple[float, float] | None = ...,
        world: ArrayLike | None = None,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> Projection: ...
    def project_along_normals(
        self,
        uv_map: SurfaceData,
        face: ArrayLike,
        uv: ArrayLike,
        source: LimitSurface,
        source_map: SurfaceData,
        texel: tuple[float, float],
        *,
        max_distance: float = ...,
        direction: Literal["both", "outward", "inward"] = "both",
        transform: ArrayLike | None = None,
        world: ArrayLike | None = None,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> Projection: ...
    def eye_is_inside(self, matrix: ArrayLike, *, threads: int = 0) -> bool: ...
    def vector_displacement(
        self,
        target: LimitSurface,
        face: ArrayLike,
        uv: ArrayLike,
        *,
        frames: ArrayLike | None = None,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> NDArray[np.float64]: ...
    def scalar_displacement(
        self,
        target: LimitSurface,
        face: ArrayLike,
        uv: ArrayLike,
        max_distance: float = ...,
        *,
        direction: Literal["both", "outward", "inward"] = "both",
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> NDArray[np.float64]: ...
    def displaced(
        self,
        face: ArrayLike,
        uv: ArrayLike,
        values: ArrayLike,
        *,
        frames: ArrayLike | None = None,
        threads: int = 0,
    ) -> NDArray[np.float64]: ...
    def scatter_jittered(
        self, per_side: int, seed: int = 0, *, faces: ArrayLike | None = None, threads: int = 0
    ) -> Locations: ...
    def scatter_uniform(
        self,
        count: int,
        seed: int = 0,
        density: ArrayLike
        | Callable[[NDArray[np.int32], NDArray[np.float64]], ArrayLike]
        | None = None,
        *,
        density_limits: ArrayLike | None = None,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> Locations: ...
    def scatter_blue_noise(
        self,
        *,
        count: int | None = None,
        radius: float | None = None,
        seed: int = 0,
        density: ArrayLike
        | Callable[[NDArray[np.int32], NDArray[np.float64]], ArrayLike]
        | None = None,
        density_limits: ArrayLike | None = None,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> BlueNoise: ...
    def guide_weights(
        self,
        guide_face: ArrayLike,
        guide_uv: ArrayLike,
        face: ArrayLike,
        uv: ArrayLike,
        count: int = 4,
        *,
        cuts: ArrayLike | None = None,
        cut_points: ArrayLike | None = None,
        cut_offsets: ArrayLike | None = None,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> GuideWeights: ...
    def tessellate(
        self,
        levels: ArrayLike,
        *,
        corner_normals: bool = False,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> Tessellation: ...
    def levels_within(
        self,
        tolerance: float,
        most: int = 8,
        *,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> FaceLevels: ...
    def levels_of_length(
        self,
        length: float,
        matrix: ArrayLike | None = None,
        nearest: float = 0.0,
        most: int = 8,
        *,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> FaceLevels: ...
    @overload
    def area(self, *, error: Literal[False] = False, threads: int = 0) -> float: ...
    @overload
    def area(self, *, error: Literal[True], threads: int = 0) -> tuple[float, float]: ...
    @overload
    def area(self, *, error: bool = False, threads: int = 0) -> float | tuple[float, float]: ...
    def bounds(self, *, threads: int = 0) -> NDArray[np.float64]: ...

def shortest_turns(source: ArrayLike, target: ArrayLike) -> NDArray[np.float64]: ...
def rotation_matrices(quaternions: ArrayLike) -> NDArray[np.float64]: ...
def quaternions(rotations: ArrayLike, *, threads: int = 0) -> NDArray[np.float64]: ...
def frames_in_world(
    frames: ArrayLike, matrix: ArrayLike, *, threads: int = 0
) -> NDArray[np.float64]: ...
def leaning(frames: ArrayLike, angles: ArrayLike, *, threads: int = 0) -> NDArray[np.float64]: ...
def straight_strands(
    roots: ArrayLike,
    along: ArrayLike,
    points: int,
    out: NDArray[np.float32] | None = None,
    *,
    threads: int = 0,
) -> NDArray[np.float32]: ...
def move_strands(
    points: ArrayLike,
    offsets: ArrayLike | None,
    roots: ArrayLike,
    new_roots: ArrayLike,
    turns: ArrayLike,
) -> NDArray[np.float64]: ...
def into_shading_frames(
    vectors: ArrayLike, normals: ArrayLike, tangents: ArrayLike, signs: ArrayLike
) -> NDArray[np.float64]: ...
def out_of_shading_frames(
    vectors: ArrayLike, normals: ArrayLike, tangents: ArrayLike, signs: ArrayLike
) -> NDArray[np.float64]: ...
