# SPDX-License-Identifier: Apache-2.0
"""The results of calls on arrays: named arrays with a row for each location."""

from dataclasses import FrozenInstanceError, dataclass, is_dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]


@dataclass(frozen=True, slots=True, eq=False)
class Evaluation:
    """Positions, derivatives and normals, (n, 3) each; None for those that were not wanted."""

    position: Array
    du: Array | None
    dv: Array | None
    duu: Array | None
    duv: Array | None
    dvv: Array | None
    normal: Array | None


@dataclass(frozen=True, slots=True, eq=False)
class DataEvaluation:
    """Data and their derivatives, (n, d) each; None for those that were not wanted."""

    value: Array
    du: Array | None
    dv: Array | None
    duu: Array | None
    duv: Array | None
    dvv: Array | None


@dataclass(frozen=True, slots=True, eq=False)
class Curvature:
    """Gaussian, mean and principal curvatures (n,), k1 >= k2; the unit directions (n, 3) of k1 and
    k2; and whether a location is exactly at an irregular vertex, where the others are an average
    or NaN."""

    gaussian: Array
    mean: Array
    k1: Array
    k2: Array
    direction1: Array
    direction2: Array
    irregular: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class PlacedFrames:
    """Positions (n, 3) and the rotations (n, 3, 3) there, whose columns are the tangent (along du),
    normal x tangent, and the normal."""

    position: Array
    frame: Array


@dataclass(frozen=True, slots=True, eq=False)
class MapDistortion:
    """The distortion of a UV map, (n,) each: the area of the surface per area of the map, and the
    largest and the smallest length on the surface per length on the map."""

    area: Array
    stretch_high: Array
    stretch_low: Array


@dataclass(frozen=True, slots=True, eq=False)
class Stencils:
    """Sparse rows (CSR) of weights of the control mesh's vertices: row i has the vertices
    indices[offsets[i]:offsets[i + 1]] and the weights at the same places. The weights of du and dv
    are None unless they were wanted."""

    offsets: NDArray[np.int64]
    indices: NDArray[np.int32]
    weights: NDArray[np.float64]
    du_weights: NDArray[np.float64] | None
    dv_weights: NDArray[np.float64] | None


@dataclass(frozen=True, slots=True, eq=False)
class Tiles:
    """The bicubic tiles of locations, and their control points. LimitSurface.tiles() says what each
    array holds."""

    points_offsets: NDArray[np.int64]
    points_indices: NDArray[np.int32]
    points_weights: NDArray[np.float64]
    tile_points: NDArray[np.int32]
    tile_anchor: NDArray[np.int32]
    tile_base: NDArray[np.int32]
    tile: NDArray[np.int32]
    tile_uv: NDArray[np.float64]
    scale: NDArray[np.float64]
    moved: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.tile)


@dataclass(frozen=True, slots=True, eq=False)
class TileQuadtree:
    """All tiles of a surface, and for each Ptex face a quadtree that leads from (u, v) to a tile.
    LimitSurface.tile_quadtree() says what each array holds."""

    child: NDArray[np.int32]
    tiles: Tiles
    origin: NDArray[np.float64]
    levels: int


@dataclass(frozen=True, slots=True, eq=False)
class Locations:
    """Locations on a surface: Ptex face ids (n,) and parameters (n, 2)."""

    face: NDArray[np.int32]
    uv: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.face)


@dataclass(frozen=True, eq=False)
class BlueNoise(Locations):
    """Locations, and the distance they keep from each other where the density is largest."""

    __slots__ = ("radius",)

    radius: float


@dataclass(frozen=True, eq=False)
class AlongCurves(Locations):
    """Locations along curves. curve (n,) is the curve's number, arc (n,) the arc length from its
    start, and row (n,) the number of the row. tangent and outward (n, 3) are unit vectors in the
    surface's tangent plane: along the curve, and away from the location's face. ended (rows,) is
    the number of locations that each row lacks."""

    __slots__ = ("arc", "curve", "ended", "outward", "row", "tangent")

    curve: NDArray[np.int32]
    arc: NDArray[np.float64]
    tangent: NDArray[np.float64]
    outward: NDArray[np.float64]
    row: NDArray[np.int32]
    ended: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class MapLocations(Locations):
    """Locations of points of a UV map. Where the map does not cover a point, face is -1 and uv NaN.
    overlap tells where several places of the surface lie at the point, and flipped where the map
    is mirrored."""

    __slots__ = ("overlap", "flipped")

    overlap: NDArray[np.bool_]
    flipped: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Texels:
    """Texels (x, y) of an image, sorted by row and then by column, and the locations of their
    centres. inside is False for texels of the margin; overlap tells where several places of the
    surface lie, and flipped where the map is mirrored."""

    x: NDArray[np.int32]
    y: NDArray[np.int32]
    face: NDArray[np.int32]
    uv: NDArray[np.float64]
    inside: NDArray[np.bool_]
    overlap: NDArray[np.bool_]
    flipped: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.face)


@dataclass(frozen=True, slots=True, eq=False)
class Hits:
    """Points found on the surface, a row for each search; where none was found, face is -1 and
    everything else NaN."""

    face: NDArray[np.int32]
    uv: Array
    position: Array
    distance: Array
    normal: Array

    def __len__(self) -> int:
        return len(self.face)


@dataclass(frozen=True, eq=False)
class RayHits(Hits):
    """All hits of rays: those of ray i are rows offsets[i] to offsets[i + 1] - 1."""

    __slots__ = ("offsets",)

    offsets: NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class LaidPaths:
    """Polylines on the surface, as LimitSurface.lay_path() makes them. Path p is rows offsets[p] to
    offsets[p + 1] - 1, comes from the curve curve[p], and is at most deviation[p] away from the
    surface, as far as was measured. place is where a point is on its curve: the number of the
    control point before it, plus a parameter up to 1."""

    face: NDArray[np.int32]
    uv: NDArray[np.float64]
    position: NDArray[np.float64]
    place: NDArray[np.float64]
    offsets: NDArray[np.int64]
    curve: NDArray[np.int32]
    closed: NDArray[np.bool_]
    deviation: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.curve)


@dataclass(frozen=True, slots=True, eq=False)
class PathFit:
    """A curve whose control points are some rows of a path, as LimitSurface.fit_path() makes it.
    The handles are None for polylines. deviation is the largest measured distance of the curve from
    the surface, error that of the path's points from the curve, and resolution the number of
    straight lines by which each segment is to be drawn."""

    rows: NDArray[np.int32]
    handle_left: NDArray[np.float64] | None
    handle_right: NDArray[np.float64] | None
    deviation: float
    error: float
    resolution: int


@dataclass(frozen=True, slots=True, eq=False)
class Projection:
    """Where texels see an image: places in it (n, 2), footprints (n, 2, 2) and weights (n,)."""

    st: NDArray[np.float64]
    footprint: NDArray[np.float64]
    weight: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.weight)


@dataclass(frozen=True, slots=True, eq=False)
class PtexTexels:
    """The pixels (x, y) of a PtexLayout, y upwards, and their locations (face, uv)."""

    x: NDArray[np.int32]
    y: NDArray[np.int32]
    face: NDArray[np.int32]
    uv: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.x)


@dataclass(frozen=True, slots=True, eq=False)
class GuideWeights:
    """The nearest guides of places, (n, count) each: their numbers, weights that add up to 1, and
    distances along the surface. Where there are fewer, guide is -1, weight 0 and distance inf."""

    guide: NDArray[np.int32]
    weight: NDArray[np.float64]
    distance: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.guide)


@dataclass(frozen=True, slots=True, eq=False)
class FaceLevels:
    """A level for each face of a mesh, and the deviation or the length that was measured there."""

    levels: NDArray[np.int32]
    measure: NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Tessellation:
    """Polygons on the limit surface, with the locations of their points and corners.
    LimitSurface.tessellate() says what each array holds."""

    positions: NDArray[np.float64]
    normals: NDArray[np.float64]
    faces: NDArray[np.int32]
    locations: Locations
    face_sizes: NDArray[np.int32]
    face_vertices: NDArray[np.int32]
    base_face: NDArray[np.int32]
    ptex_face: NDArray[np.int32]
    corner_uv: NDArray[np.float32]
    corner_normals: NDArray[np.float64] | None

    @property
    def corner_locations(self) -> Locations:
        """The locations of the polygons' corners, each on its polygon's own Ptex face."""
        face = np.repeat(self.ptex_face, self.face_sizes)
        return Locations(face, self.corner_uv.astype(np.float64))


def _refuse_value(self: object, name: str, value: object) -> None:
    raise FrozenInstanceError(f"cannot assign to {name!r}: results do not change")


def _refuse_deletion(self: object, name: str) -> None:
    raise FrozenInstanceError(f"cannot delete {name!r}: results do not change")


# What dataclass() itself adds to classes with slots fails at names that are no field.
for _class in list(vars().values()):
    if isinstance(_class, type) and is_dataclass(_class):
        setattr(_class, "__setattr__", _refuse_value)  # noqa: B010 (mypy refuses the assignment)
        setattr(_class, "__delattr__", _refuse_deletion)  # noqa: B010
