// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

constexpr const char* kControlMeshDoc =
    R"(A control mesh (cage): positions, faces of any size, and the rules of their subdivision.

Parameters
----------
positions : (V, 3) array of float
    The vertices. Any unit of length will do: results in another unit are the same numbers, scaled.
    All coordinates must be finite and at most 2^400 (2.6e120). Unless all vertices are in one place,
    the longest side of their bounding box must be at least 2^-400.
face_sizes : (F,) array of int
    The number of vertices of each face, 3 to 65,535.
face_vertices : (sum of face_sizes,) array of int
    The vertex indices of all faces, one face after the other, counter-clockwise as seen from outside.
edge_sharpness : (edges (E, 2) int, values (E,) float), optional
vertex_sharpness : (vertices (n,) int, values (n,) float), optional
    0 is smooth, 10 and more (inf included) is infinitely sharp, and a value between is sharp for that
    many steps of subdivision. Values are rounded to float32. An edge or a vertex may be given
    again only with the same value.
boundary : 'smooth' or 'corners'
    'smooth': every boundary is a uniform cubic B-spline curve (OpenSubdiv's EDGE_ONLY, Blender's
    'ALL'). 'corners': boundary vertices with one face are interpolated.
creasing : 'uniform' or 'chaikin'
    'chaikin' averages the sharpness of an edge with that of the other semi-sharp edges at its vertices
    in each step of subdivision; infinitely sharp ones do not count.
triangles : 'catmark' or 'smooth'
    The rule for triangles; 'smooth' is OpenSubdiv's TRI_SUB_SMOOTH.
scheme : 'catmark' or 'bilinear'
    With 'bilinear' each Ptex face is a bilinear patch, and sharpness has no effect.
holes : (n,) array of int, optional
    Faces that have no surface, but belong to the neighbourhoods of other faces.

Raises
------
MeshError
    For face sizes that do not add up, indices out of range, positions that are not finite or out of
    range, an edge or a vertex with two values of sharpness, more than 65,535 edges at a vertex, and
    unknown options. A face that only has no limit surface is no error: LimitSurface.refused lists it.
TypeError
    For arrays of the wrong kind, such as floats instead of indices, and for masked arrays.

Cost: O(number of corners).
)";

constexpr const char* kFromFacesDoc =
    R"(The control mesh whose faces are given as an (F, k) array or as a list of lists of vertex indices.

All other parameters, and the errors raised, are those of ControlMesh.)";

constexpr const char* kLimitSurfaceDoc =
    R"(The Catmull-Clark limit surface of a control mesh, evaluated exactly at any location.

A location is (face, u, v): a Ptex face id and parameters in [0, 1]. A quad is one Ptex face, with
(0,0), (1,0), (1,1), (0,1) at its vertices 0 to 3. An n-gon consists of n Ptex faces, one for each
corner, with (0,0) at the corner, u towards the next vertex and (1,1) at the centre.

The topology is analysed once, when the surface is made; set_positions() changes the pose at a low
cost. Every call on arrays releases the GIL, uses all cores (threads=0) or at most n (threads=n), and
ends on Ctrl-C. The bits of a result depend neither on the number of threads nor on the rest of the
batch. (If more derivatives are wanted, the last bits of the others may change.)

The method is that of Stam ("Exact Evaluation of Catmull-Clark Subdivision Surfaces at Arbitrary
Parameter Values", 1998) in the interior, and that of Lacewell & Burley ("Exact Evaluation of
Catmull-Clark Subdivision Surfaces Near B-Spline Boundaries", 2007) at boundaries, for any valence.
)";

constexpr const char* kSetPositionsDoc =
    R"(Gives the surface another pose: new positions, (V, 3) float, of the vertices of the same mesh.

Waits for evaluations that run in other threads. Raises MeshError for an array of another shape and for
values that ControlMesh refuses. Then nothing has changed, nor if Ctrl-C ends the call. Raises
RuntimeError if it is called by a function that a call on the same surface runs (a progress function,
for example). Cost: O(V), plus O(valence^2) for each irregular vertex.
)";

constexpr const char* kEvaluateDoc =
    R"(Evaluates limit positions, and derivatives with respect to the face's own (u, v).

Parameters
----------
face : int or (n,) array of int
    Ptex face ids.
uv : (n, 2) array of float in [0, 1]
derivatives : 0, 1 or 2
    The highest order of derivatives that is wanted.
threads : int
    0 uses all cores, any other number at most so many.
dtype : float64 or float32
    The type of the results. Everything is computed in float64.

Returns
-------
Evaluation
    .position; with derivatives >= 1 .du .dv .normal; with derivatives=2 .duu .duv .dvv; (n, 3) each.
    Those that are not wanted are None. Positions are always finite. Exactly at an irregular vertex
    derivatives along a boundary of the face are those of the limit curve, and du = dv = 0 at interior
    valence 2 and 3. All other derivatives are NaN there, and so is the normal if it depends on the
    direction from which the vertex is approached. The normal is also NaN where du x dv consists only
    of rounding errors, as on a fold or on a face without area.

Error bounds: positions 1e-13 of the bounding box's diagonal; du and dv 1e-12, and second derivatives
1e-11, of the value itself or of the largest value on the face, whichever is larger; normals 1e-11
radians, times their condition number. The condition number is S sqrt(2 (du^2 + dv^2)) divided by the
length of du x dv, where S is the size of the patch's control polygon. It is large only on slivers and
near folds. Where it exceeds 2^30, the normal is NaN.

Cost: O(1) a location, O(valence) within about 1/16 of an irregular vertex.

Raises LocationError naming the first row that is out of range, MeshError for a refused face, and
TypeError for faces that are not integers.
)";

constexpr const char* kFramesDoc =
    R"((n, 3, 3) rotations whose columns are the tangent (along du), normal x tangent, and the normal.

Frames are always finite. At an irregular vertex the frame is the limit for u = v = 2^-n, measured from
the vertex. (At interior vertices and darts of two faces even and odd n approach different directions;
docs/accuracy.md says which frame is taken.) Where du or the normal vanishes, the frame is completed
from dv, then from the world axis that is least aligned with it. Parameters and errors are those of evaluate().
)";

constexpr const char* kPlacedFramesDoc =
    R"(Positions and frames at the same locations, in one evaluation: PlacedFrames.

.position (n, 3) has the same bits as that of evaluate(), and .frame (n, 3, 3) as frames(). Parameters
and errors are those of evaluate().
)";

constexpr const char* kCurvatureDoc =
    R"(The curvature of the surface.

Returns Curvature: .gaussian .mean .k1 .k2 (n,), with k1 >= k2, in the inverse (gaussian: squared
inverse) unit of length; the unit directions .direction1 .direction2 (n, 3) of k1 and k2; and .irregular
(n,) bool, which is True exactly at an irregular vertex, where curvature has no limit in general. Signs
depend on the normal: a sphere whose normals point outwards has negative curvature.

At an irregular vertex the result depends on `irregular`:

'none': everything is NaN.
'average': the result is a mean over the faces of the location's own sector, which are those around the
    vertex that no boundary or infinitely sharp edge separates from the location's face. On each of them
    four places lie on a square with the vertex at one corner: at (1, 1/4), (1, 3/4), (3/4, 1) and
    (1/4, 1) times its side, measured from the vertex. The side is `radius` in u and v on a quad, and
    2 * radius on a sub-face of an n-gon, whose sides are half edges. The shape operators at these places
    are rotated into the vertex's tangent plane, each by the smallest possible rotation, and averaged
    with the area as weight. k1, k2 and the directions are those of the mean; gaussian is k1 * k2. All
    faces of the sector return the same bits. A mesh that is subdivided once returns the same result at
    twice the radius.

If the vertex has no normal, the plane is perpendicular to the mean of the normals at the places. Places
at which the surface is singular (du x dv = 0) or has an opposite normal are left out. If none remains,
and at singular places anywhere, the result is NaN.

Error bound: 1e-9 of the larger of |k1| and |k2|, down to 2^-40 of a face beside irregular vertices of up
to 64 faces; of averages, 1e-9 of the largest averaged curvature, for radii from 2^-40 on. Cost: as
evaluate(), and O(valence^2) for each such vertex, and O(faces) for each 131,072 locations if any is at
such a vertex.

Raises ValueError for a radius outside (0, 1/2], MeshError for another `irregular`, and all errors that
evaluate() raises.
)";

constexpr const char* kStencilsDoc =
    R"(The exact weights with which positions (with derivatives=1 also du and dv) depend on the vertices.

Positions and derivatives are linear in the vertices of the control mesh. Returns Stencils in CSR form:
row i has the vertices .indices[.offsets[i]:.offsets[i + 1]] and the corresponding .weights, .du_weights
and .dv_weights (None unless wanted). The weights of a position add up to 1, those of a derivative to 0.
Where a derivative has no limit its weights are NaN. Weights depend on the topology alone, so they are
valid for all poses.

Parameters and errors are those of evaluate(). Cost: as evaluate(), but O(valence^2) on tiles at an
irregular vertex.
)";

constexpr const char* kFaceVaryingDoc =
    R"(Data given at the corners of faces, such as a UV map: SurfaceData.

Each corner of a face refers to a row of values. An edge whose two faces refer to different rows at
either end is a seam. Where no seam meets a vertex, the data are as smooth there as the surface.
By 'none', 'corners_only' and 'corners_plus1' a seam that ends at a vertex ends as a crease does, even if
all corners at the vertex refer to the same row.

Parameters
----------
values : (m, d) or (m,) array of float
    Values must be finite and at most 2^400 (2.6e120); (m,) means (m, 1).
indices : (sum of the mesh's face_sizes,) array of int
    The row of values of each corner, one face after the other, in the order of face_vertices.
interpolation : str
    Where the data are linear, by OpenSubdiv's rules FVAR_LINEAR_*:
    'none': nowhere. Seams and boundaries are smooth curves, also around corners of one face, but for
        vertices that the mesh's own rules pin (boundary='corners', infinitely sharp vertices), and for
        rows that return around a vertex, after other rows: these are interpolated there.
    'corners_only': at values that have only one face at a vertex: these are interpolated, and so are
        rows that return around a vertex.
    'corners_plus1': also at junctions of more than two values, and at values across a seam from one
    that a sharp edge pins.
    'corners_plus2': also where a seam ends inside, and at both values of a vertex if one of the two
    has only one face.
    'boundaries': along seams and boundaries, which are straight from value to value.
    'all': everywhere; the data are bilinear on each Ptex face.
threads : int

Sharp edges and vertices are as sharp for the data as for the surface. The data have values on all
faces that have a limit surface.

By 'none' and 'corners_only' the data near some vertices depend on the order of the faces, as they do in
OpenSubdiv. It goes around a vertex inside counter-clockwise, from the face with the lowest number, and
collects the rows. If the second row returns before a third one is met (A, B, A, B), these later faces
count as a row of their own, which is joined with no other one and not interpolated. So the data depend on
where OpenSubdiv begins exactly if somewhere around the vertex (beginning anywhere; A, B, A, C, B has B, A,
B, A) the rows are A, B, A, B, each of them for one face or several in succession. By 'corners_only' this
matters only if the last of the four has several faces, or if the second has several faces and the row B
occurs nowhere else around the vertex: rows of one face are interpolated in any case.

Raises
------
MeshError
    For an index out of range, naming the corner, and for values that are not finite or too large,
    naming the row.
TypeError
    For indices that are not integers.

Cost: that of making the surface.
)";

constexpr const char* kVertexDataDoc =
    R"(Data at the vertices, (V, d) or (V,) float, subdivided exactly as positions are: SurfaceData.

Raises MeshError for another number of rows and for values that are not finite or beyond 2^400. Cost:
that of set_positions() for every three columns.
)";

constexpr const char* kVaryingDoc =
    R"(Data at the vertices, (V, d) or (V,) float, linear along edges and bilinear on each Ptex face.

A sub-face of an n-gon has the values of its corner, of the midpoints of two edges, and the mean of all
corners. Returns SurfaceData. Raises the errors of vertex_data(). Cost: that of making the surface.
)";

constexpr const char* kSurfaceDataDoc =
    R"(Data on a limit surface, evaluated exactly.

LimitSurface.face_varying(), .vertex_data() and .varying() return them. They do not depend on the
positions of the surface, and may outlive it. They cannot be copied or pickled.
)";

constexpr const char* kEvaluateDataDoc =
    R"(Evaluates the data, and their derivatives with respect to the face's own (u, v).

Parameters and errors are those of LimitSurface.evaluate(). Returns DataEvaluation: .value; with
derivatives >= 1 .du .dv; with derivatives=2 .duu .duv .dvv; (n, d) each, None if not wanted. Exactly at
a vertex that is irregular for the data, derivatives that have no limit are NaN.

Error bounds are those of LimitSurface.evaluate(), relative to the bounding box of the values. Cost:
that of LimitSurface.evaluate() for every three columns.
)";

constexpr const char* kDataBoundsDoc =
    R"(Boxes around the data on side x side equal squares of each Ptex face: (f, side, side, 2, d).

[face, row, column] holds the lower and the upper bounds of all values that evaluate() returns on one
square, borders included; rows count along v, columns along u. For varying data and for linear
interpolation they are exact but for a padding of 1.25e-13 of the diagonal of the values' bounding box.
For smooth data they are the bounds of Bezier control points: wider than the values by an amount that
falls in proportion to 1 / side^2. NaN on faces that have no surface.

side is 1 to 1024. Raises ValueError for another one. Cost: O(f side^2 d), about 0.3 microseconds for
three columns of a square.
)";

constexpr const char* kSetValuesDoc =
    R"(Replaces the values by others of the same shape, (m, d) or (m,) float.

Waits for evaluations in other threads. Raises MeshError for another shape and for values that are not
finite; then nothing has changed. Raises RuntimeError if it is called by a function that a call on the
same data runs. Cost: that of LimitSurface.set_positions() for every three columns.
)";

constexpr const char* kVertexLocationsDoc =
    R"(A location (.face, .uv) of every vertex of the control mesh, in the order of the vertices: Locations.

face is -1 and uv NaN for vertices that no face with a limit surface has.
)";

constexpr const char* kClosestDoc =
    R"(The closest point of the limit surface to each of (n, 3) points.

The exact surface is searched, not polygons; boundaries, creases and corners are parts of it. Points
farther than max_distance are not found. With facing, directions (n, 3) or (3,), a point counts only if
its normal is within max_angle (radians, 0 to pi) of the direction, and if the distance has a local
minimum there on the smooth part of the surface that contains it; boundaries and infinitely sharp edges
end such a part. progress is a function that is called from time to time with the part of the work that
is done, 0 to 1; an exception that it raises ends the call.

Returns Hits: .face (n,) int32, .uv (n, 2), .position and .normal (n, 3), those of evaluate() at the
location, and .distance (n,). Where no point is found face is -1 and everything else NaN.

Error bound: the point found is farther away than the true minimum by at most 1e-12 of the control
mesh's diagonal, at any distance. The method is branch and bound over control hulls, with Newton's
iteration where the distance is convex. Cost: some microseconds a point. The first call builds a search
tree that is kept until set_positions().

Raises ValueError for arrays of other shapes, for points that are not finite, and for a max_distance or
max_angle out of range.
)";

constexpr const char* kRayCastDoc =
    R"(The first point at which each ray meets the limit surface, from either side.

origins and directions are (n, 3) each; directions need not be unit vectors. A ray that touches the
surface within 1e-12 of the control mesh's diagonal hits it, and no ray passes between two faces.
Returns Hits (see closest()); .distance is measured along the normalised direction and lies between 0
and max_distance. Error bound of hits: 1e-12 of the diagonal, for origins within 1,000 diagonals of the
mesh.

Raises ValueError for arrays of other shapes, for rows that are not finite, and for directions of
length 0. Cost: some microseconds a ray; the first call builds the search tree of closest().
)";

constexpr const char* kRayCastAllDoc =
    R"(All points at which each ray meets the limit surface, sorted along the ray.

Parameters and errors are those of ray_cast(). Returns RayHits: the fields of Hits with a row for each
hit, and .offsets (n + 1,) int64; the hits of ray i are rows offsets[i] to offsets[i + 1] - 1. A hit on
the border of several faces counts once. Where a ray runs within the surface, one point at the beginning
of each patch is returned.
)";

constexpr const char* kTessellateDoc =
    R"(Watertight polygons on the limit surface: 2^levels x 2^levels quads a face.

A sub-face of an n-gon has half as many quads a side, so levels must be at least 1 if there are n-gons.
levels may also be (F,) integers, one for each face of the mesh; those of refused faces are ignored. The
larger level of the two faces of an edge then decides how many segments the edge has, 2^level, and the
coarser face has smaller quads and triangles towards it.

Returns Tessellation:
    .positions .normals (n, 3), .locations: the points, each of which exists once
    .faces (m, 4) int32: the polygons; rows of triangles end in -1
    .face_sizes (m,) .face_vertices (k,) int32: the same polygons without padding
    .base_face .ptex_face (m,) int32: the face of the mesh, and the Ptex face, on which a polygon lies
    .corner_uv (k, 2) float32: (u, v) of the polygons' corners on their own Ptex face, exactly
    .corner_locations: the same as Locations
    .corner_normals (k, 3): None unless corner_normals=True; the normals of the polygon's own face, so
        that they are one-sided at creases
Normals are always finite: at irregular vertices without a normal they are the third column of frames().
progress is called with the part of the work that is done, 0 to 1.

Raises ValueError naming the first face whose level is not 0 (on n-gons 1) to 12. Cost: an evaluation
for each point.
)";

constexpr const char* kLevelsWithinDoc =
    R"(The lowest levels for tessellate() at which polygons are within `tolerance` of the surface.

Deviations are measured, not bounded: along the surface's normal, between the surface and both ways of
cutting a polygon into triangles, at the middles of sides, diagonals and quads and at 8 or more places
along each side of a Ptex face. On boundaries and infinitely sharp edges the distance of the sides is
measured as well. Levels of neighbours are raised until they differ by at most 2 across an edge.

Returns FaceLevels: .levels (F,) int32, and .measure (F,), the deviation at that level or, if a neighbour
raised it, at a lower one; it exceeds `tolerance` where the level `most` is too low. Refused faces have 0
and NaN. Raises ValueError unless tolerance is above 0 and most is 1 to 12. Cost: four to six evaluations
for each point of the tessellation.
)";

constexpr const char* kLevelsOfLengthDoc =
    R"(The lowest levels for tessellate() at which the sides of polygons are no longer than `length`.

With a matrix (4, 4) lengths are measured in a picture: matrix @ (x, y, z, 1) are its homogeneous
coordinates, and points with w < nearest are not visible and have no length. Lengths are measured along
the surface, between places at eighths of each side of a Ptex face; where a side has more quads than that,
their sides are equal parts of such lengths, and the quads at its corners are measured as well. Between
these places sides may be longer. Levels of neighbours are raised until they differ by at most 2 across an
edge.

Returns FaceLevels: .levels (F,) int32, and .measure (F,), the longest side at that level or, if a
neighbour raised it, at a lower one; it exceeds `length` where the level `most` is too low. Refused faces
have 0 and NaN. Raises ValueError unless length is above 0 and most is 1 to 12. Cost: 81 evaluations for
each Ptex face.
)";

constexpr const char* kRasterizeDoc =
    R"(The locations of an image's texels on the surface, by the exact inverse of the UV map.

Parameters
----------
width, height : int, 1 to 65,536
tile : (int, int)
    The image covers [i, i + 1] x [j, j + 1] of the map, which is UDIM tile 1001 + i + 10 j.
margin : float
    In texels, 0 to 4,096. A texel outside the map's image whose centre is no farther from it than that
    gets the nearest location on the border of the image.
threads : int
progress : function, optional
    It is called with the part of the work that is done, 0 to 1.

Returns
-------
Texels
    Sorted by row (y), then by column (x), with y upwards as in Blender's images. The centre of texel
    (x, y) is tile + ((x + 0.5) / width, (y + 0.5) / height) on the map.
    .x .y : (n,) int32
    .face : (n,) int32, .uv : (n, 2)
        The location. The map takes it to the centre of the texel up to 1e-12 of the diagonal of the
        box around the map's values and (0, 0).
    .inside : (n,) bool
        False for texels of the margin.
    .overlap : (n,) bool
        The map takes several places of the surface there. The place on the lowest Ptex face is
        returned; on one face that with the lowest v, then the lowest u.
    .flipped : (n,) bool
        The map is mirrored there.

No texel is lost on edges that faces share. Faces whose image has no area cover no texels.

Raises ValueError for data of other than two columns, and for sizes out of range. Cost: O(faces log
faces) for the first call on these values, then O(texels).
)";

constexpr const char* kLocateDoc =
    R"(The places of the surface that the UV map takes to points (n, 2).

Returns MapLocations: .face (n,) and .uv (n, 2), which are -1 and NaN where the map does not cover the
point; .overlap and .flipped are those of rasterize(). A point on the border of the map counts as covered.

Raises ValueError for data of other than two columns, and naming the first row that is not finite.
)";

}  // namespace limitsurf::python
