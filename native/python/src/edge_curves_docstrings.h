// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

constexpr const char* kEdgeCurvesDoc =
    R"(Limit curves of chains of edges, measured by their true arc length (LimitSurface.edge_curves()).

len() is the number of curves. They are sorted by their first edges, in the order in which the faces use
the edges. A curve runs in the direction in which the first face of its first edge uses that edge, so this
face is on its left; a closed curve begins with that edge. Curves of boundaries therefore have the surface
on their left. The curves belong to the pose that the surface had when they were made. They cannot be
copied or pickled.
)";

constexpr const char* kEdgeCurvesMakerDoc =
    R"(The limit curves of edges of the control mesh, linked to chains: EdgeCurves.

Parameters
----------
edges : 'boundary', 'creases', or (E, 2) array of int
    'boundary': the edges of exactly one face. 'creases': the edges of two faces with a sharpness above
    0, those of three and more faces, and those of faces of opposite winding. Otherwise the two vertices
    of each edge, in any order; an edge that is given twice counts once.
threads : int
    0 uses all cores.

A curve goes on through vertices at which exactly two of the edges meet, and ends at all others. Edges
whose faces all have no limit surface are left out. Lengths have a relative error of at most 1e-9, also at
extraordinary vertices.

Raises MeshError for an unknown word, and naming the first row that is no edge of the mesh; TypeError for
an array of another kind. Cost: O(faces log faces), about 0.1 s for 100,000 faces, and some microseconds
for each edge.
)";

constexpr const char* kEdgeCurvesAtDoc =
    R"(The points at arc lengths along curves: AlongCurves as scatter_along() gives them.

Parameters
----------
curve : (n,) array of int, or one int
    Numbers of curves.
arc : (n,) array of float
    Arc lengths from the start of each curve, from 0 to its length, in units of the mesh.
side : 'left' or 'right'
    The side of the curves whose faces the locations are on. Where no face with a surface is on that side,
    they are on the other one.
threads : int
    0 uses all cores.

Raises ValueError for a number that is no curve and for an arc length out of range, naming the row, and if
the surface has been posed since the curves were made. The arc length of a location differs from the one
asked for by at most 1e-12 of the curve's length. Cost: about 1 microsecond a row.
)";

constexpr const char* kScatterAlongDoc =
    R"(Locations evenly along curves, by their true arc length: AlongCurves.

Parameters
----------
curves : EdgeCurves
    Curves of this surface, in its present pose.
count : int, optional
    The number of locations on all curves together. It is divided in proportion to their lengths.
spacing : float, optional
    The arc length between neighbours. On each curve it is rounded so that it divides the curve's length;
    a curve that is shorter than half of it gets one location. Exactly one of count and spacing must be
    given.
jitter : float
    The part of the spacing by which locations are moved at random along the curve, 0 to 1: by half of it
    at most to each side.
seed : int
    0 to 2^64 - 1. A seed gives the same locations on every machine and with any number of threads.
phase : float, optional
    Where the first location lies, as a part of the spacing, 0 to 1. By default it is random for each curve
    and row. If jitter moves a location beyond the end of an open curve, it is reflected.
side : 'left' or 'right'
    The side of the curves whose faces the locations are on. Where no face with a surface is on that side,
    they are on the other one.
rows : int
    The number of rows. Row r lies r times row_distance away from the curves, on the faces of the given
    side: its locations are the ends of geodesics that leave the curves perpendicularly. Each row has other
    random places.
row_distance : float
    The distance between rows along the surface, in units of the mesh, above 0 if there are several rows.
threads : int
    0 uses all cores.
progress : function, optional
    It is called from time to time with the part of the work that is done, 0 to 1. An exception that it
    raises ends the call.

Returns AlongCurves, sorted by row, curve and place along the curve:
    .face (n,) int32 and .uv (n, 2): the locations
    .curve (n,) int32, .row (n,) int32
    .arc (n,): the arc length from the curve's start; in further rows, of the place on the curve at which
        the location's geodesic begins
    .tangent and .outward (n, 3): unit vectors in the surface's tangent plane, along the curve, and
        perpendicular to it and away from the location's face; in further rows, towards that place
    .ended (rows,) int64: the number of locations that each row lacks

A row ends where the surface ends, and where it would run into itself or another row: a location is left
out if another part of the curves is nearer than the row's distance. All other locations are at that
distance, to 1 %. Nearer parts are searched by geodesics towards the places that are nearer in space.

Raises ValueError for values out of range, for a count above 0 on curves without length, and if the
surface has been posed since the curves were made. Cost: about 1 microsecond a location on the curves,
and for each location in other rows some microseconds for each face up to it, several times as much where
curves are near each other.
)";

}  // namespace limitsurf::python
