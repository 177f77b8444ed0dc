// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

constexpr const char* kControlMeshDoc =
    R"(A control mesh (cage): positions, faces of any size, and the rules of their subdivision.

Parameters
----------
positions : (V, 3) array of float
    Finite; any unit of length.
face_sizes : (F,) array of int
    Vertices of each face, 3 to 65,535.
face_vertices : (sum of face_sizes,) array of int
    Vertex indices of all faces, one face after the other, counter-clockwise seen from outside.
edge_sharpness : (edges (E, 2) int, values (E,) float), optional
vertex_sharpness : (vertices (n,) int, values (n,) float), optional
    0 is smooth, 10 and more (inf included) infinitely sharp, and what lies between sharp for so many
    steps of subdivision; rounded to float32. Of an edge that is given twice the last counts.
boundary : 'smooth' or 'corners'
    'smooth': every boundary is a uniform cubic B-spline curve (OpenSubdiv's EDGE_ONLY, Blender's
    'ALL'); 'corners': boundary vertices with one face stay where they are.
creasing : 'uniform' or 'chaikin'
    'chaikin' averages sharpness with that of the other edges at a vertex, step by step.
triangles : 'catmark' or 'smooth'
    'smooth': OpenSubdiv's TRI_SUB_SMOOTH.
scheme : 'catmark' or 'bilinear'
    'bilinear': each Ptex face is a bilinear patch, and sharpness means nothing.
holes : (n,) array of int, optional
    Faces that have no surface, though their neighbours see them.

Raises
------
MeshError
    For what makes the mesh meaningless: sizes that do not add up, indices out of range, positions
    that are not finite, more than 65,535 edges at a vertex, and options that are not known.
    Faces that merely have no limit surface are told by LimitSurface.refused instead.
TypeError
    For arrays of the wrong kind, such as floats where indices are wanted.
)";

constexpr const char* kFromFacesDoc =
    R"(The same from faces given as an (F, k) array or as a list of lists of vertex indices.)";

constexpr const char* kLimitSurfaceDoc =
    R"(The Catmull-Clark limit surface of a control mesh, evaluated exactly at any location.

A location is (face, u, v): a Ptex face id and parameters in [0, 1]. A quad is one Ptex face with
(0,0), (1,0), (1,1), (0,1) at its vertices 0 to 3; an n-gon is n of them, one per corner, with (0,0)
at the corner, u towards the next vertex and (1,1) at the centre.

Topology is analysed once, here; set_positions() re-poses cheaply. Every call on arrays releases the
GIL, uses all cores (threads=0; threads=n at most n), can be interrupted, and gives the same bits for
a location whatever the thread count and the rest of the batch. (Asking for more derivatives may
change the last bits of the others.)

The method is Stam 1998 inside and Lacewell & Burley 2007 at boundaries, at any valence.
)";

constexpr const char* kSetPositionsDoc =
    R"(Re-pose: the same topology under new positions, (V, 3) float.

Raises MeshError for another shape or values that are not finite, and then changes nothing. Costs
O(V) and the irregular faces; waits for evaluations that run in other threads.
)";

constexpr const char* kEvaluateDoc =
    R"(Limit positions and derivatives with respect to the face's own (u, v).

Parameters
----------
face : int or (n,) array of int
uv : (n, 2) array of float in [0, 1]
derivatives : 0, 1 or 2
threads : int
dtype : float64 or float32
    Of the results; all is computed in float64.

Returns
-------
Evaluation
    .position and, as far as asked for (else None), .du .dv .normal, .duu .duv .dvv; (n, 3) each.
    Exactly at an irregular vertex: position always; derivatives along a boundary that bounds the
    face are the limit curve's; du = dv = 0 at interior valence 2 and 3; all others are NaN, and so
    is the normal where approaches to the vertex do not agree on one.

Error: position 1e-13 of the bounding box's diagonal; du, dv 1e-12 and second derivatives 1e-11 of
the larger of the value itself and the face's largest; normals 1e-11 radians (at a smooth corner of
one face only outside 2^-20 of the vertex).

Cost: O(1) a location, O(valence) within about 1/16 of an irregular vertex.

Raises LocationError naming the first row out of range, MeshError for a refused face, TypeError for
faces that are not integers.
)";

constexpr const char* kFramesDoc =
    R"((n, 3, 3) rotations whose columns are the tangent (along du), normal x tangent, and the normal.

Always finite: at an irregular vertex the limit over u = v = 2^-n as seen from the vertex; where du
or the normal vanishes, completed from dv, then from the least aligned world axis.
)";

constexpr const char* kCurvatureDoc =
    R"(Curvature: .gaussian .mean .k1 .k2 (n,) with k1 >= k2, and their unit .direction1 .direction2 (n, 3).

Signs follow the normal: a sphere seen from outside curves negatively. .irregular (n,) bool tells the
locations exactly at an irregular vertex, where curvature has no limit in general. There

irregular="none": all is NaN;
irregular="average": a mean over the faces of the location's own sector, those around the vertex that
    boundaries and infinitely sharp edges do not part from its face. On each of them four places stand
    on a square with the vertex at one corner and sides of `radius` edges: at (1, 1/4), (1, 3/4),
    (3/4, 1), (1/4, 1) times the side, as seen from the vertex. The side is `radius` in u and v on a
    quad, and 2 * radius on a sub-face of an n-gon, whose sides are half edges. Their shape operators,
    each turned by the shortest rotation into the vertex's tangent plane, are averaged, weighted by
    area. k1, k2 and the directions are the mean's; gaussian is k1 * k2. All faces of the sector give
    the same bits; a mesh subdivided once gives the same at twice the radius.

Where the vertex has no normal the plane is perpendicular to the mean of the places' normals. Places
where the surface is singular (du x dv = 0), or turned the opposite way, are left out; where none
remains, and at singular places anywhere, the result is NaN.

Error of averages: 1e-9 of what curvature would be if second derivatives all pointed along the normal;
below a radius of 2^-40 or so no digit is left of it. Cost: O(valence^2) for each such vertex,
and O(faces) for each 131,072 locations that need any.

Raises ValueError for a radius outside (0, 1/2], MeshError for another word, and as evaluate().
)";

constexpr const char* kStencilsDoc =
    R"(The exact linear weights of position (and du, dv with derivatives=1) on the cage's vertices.

Returns Stencils in CSR form: row i is .indices[.offsets[i]:.offsets[i + 1]] with .weights,
.du_weights, .dv_weights (None if not asked for). Position weights add up to 1, the others to 0. Where
a derivative has no limit its weights are NaN. Weights depend on topology alone: they serve all poses.

Cost: as evaluate(), but O(valence^2) on tiles at an irregular vertex.
)";

constexpr const char* kFaceVaryingDoc =
    R"(Data that every face corner picks for itself, such as a UV map: SurfaceData.

Where all corners around a vertex pick the same row the data are as smooth as the surface; an edge
whose two faces pick different rows, at either end, is a seam.

Parameters
----------
values : (m, d) or (m,) array of float
    Finite; (m,) is taken for (m, 1).
indices : (sum of the mesh's face_sizes,) array of int
    A row of values for each corner, one face after the other, as face_vertices.
interpolation : str
    Where the data are linear, by OpenSubdiv's FVAR_LINEAR_* rules:
    'none': nowhere. Seams and boundaries are smooth curves, also around corners of one face.
    'corners_only': values with one face at a vertex stay where they are.
    'corners_plus1': so do those at junctions of more than two values, and those across a seam from
    a value that a sharp edge pins.
    'corners_plus2': so do those where a seam ends inside, and both at a vertex where one of two has
    one face.
    'boundaries': seams and boundaries are straight from value to value.
    'all': bilinear on each Ptex face.
threads : int

Sharp edges and vertices are as sharp for the data as for the surface. Faces around a vertex where
seams meet semi-sharp edges that decay in a way that is not supported are refused when evaluated:
'chaikin' creases of different sharpness, or, with 'corners_plus1' and 'corners_plus2', several
edges on one side only that decay to an average which no float32 sharpness decays to.

Raises
------
MeshError
    For an index out of range, naming the corner, or values that are not finite, naming the row.
TypeError
    For indices that are not integers.

Cost: as making the surface.
)";

constexpr const char* kVertexDataDoc =
    R"(Data at the vertices, (V, d) or (V,) float, interpolated exactly as positions are: SurfaceData.

Raises MeshError for another number of rows and values that are not finite. Costs a set_positions()
for every three columns.
)";

constexpr const char* kVaryingDoc =
    R"(Data at the vertices, (V, d) or (V,) float, linear along edges and bilinear on each Ptex face.

A sub-face of an n-gon has the values of its corner, of its edges' midpoints and the mean of all
corners. Returns SurfaceData; raises as vertex_data(). Cost: as making the surface.
)";

constexpr const char* kSurfaceDataDoc =
    R"(Data on a limit surface, evaluated exactly: what LimitSurface.face_varying(), .vertex_data() and
.varying() return.

It does not depend on the surface's positions and may outlive the surface. It does not pickle.
)";

constexpr const char* kEvaluateDataDoc =
    R"(The data and their derivatives with respect to the face's own (u, v).

Parameters are those of LimitSurface.evaluate(), and so are the errors raised. Returns
DataEvaluation: .value and, as far as asked for (else None), .du .dv, .duu .duv .dvv; (n, d) each.
Exactly at a vertex that is irregular for the data, derivatives without a limit are NaN.

Error bounds are those of LimitSurface.evaluate(), relative to the values' bounding box. Cost: as
that, for every three columns.
)";

constexpr const char* kSetValuesDoc =
    R"(Other values, (m, d) or (m,) float as before, in the same places.

Raises MeshError for another shape or values that are not finite, and then changes nothing. Costs a
LimitSurface.set_positions() for every three columns; waits for evaluations in other threads.
)";

constexpr const char* kVertexLocationsDoc =
    R"(Locations (.face, .uv) of all cage vertices, in vertex order.

face = -1, uv = NaN for vertices of no face with a limit surface.
)";

constexpr const char* kScatterJitteredDoc =
    R"(per_side x per_side random locations a Ptex face, one in each cell of a regular grid.

Lacewell & Burley 2007, figure 1. Locations (.face, .uv) in face order; refused faces get none. The
same seed (0 to 2^64 - 1) gives the same locations on every machine.
)";

constexpr const char* kScatterUniformDoc =
    R"(Independent random locations, uniform by limit area, or in proportion to area times density.

Exactly so, inside each face as well: |du x dv| decides, not (u, v). Returns Locations (.face, .uv)
in random order; the first n of a longer sequence are what a count of n gives. The same seed (0 to
2^64 - 1) gives the same locations on every machine and with any number of threads.

density: (V,) weights of the vertices, linear over each Ptex face, or a function of (face, uv),
arrays (n,) int32 and (n, 2), that returns (n,) weights. Weights are relative, finite and at least
0; where they are 0 there is nothing. The function must not call set_positions(); the larger its
largest value is than its mean, the longer it takes. progress, a function, is called now and then
with the part done, 0 to 1; what it raises ends the call.

Raises ValueError for a negative count, densities that are negative, not finite, of another shape or
0 everywhere, and a surface without area. Some 0.2 microseconds a location; the first call builds a
table that is kept until set_positions().
)";

constexpr const char* kScatterBlueNoiseDoc =
    R"(Random points that keep a distance from each other (Poisson-disk sampling, blue noise).

Exactly one of count and radius. Two points are in conflict if the chord between them is shorter
than the radius and the normals there are less than 90 degrees apart: the sides of a thin sheet do
not see each other. With a radius the points are maximal: nowhere is there place for one more, to
1/512 of the radius. With a count there are exactly so many, as far apart as such random points get.
Returns BlueNoise: .face, .uv in face order and .radius, the distance that the points keep.

density, seed and progress: as for scatter_uniform(). The radius grows as 1 / sqrt(density / largest
density), and two points keep the mean of theirs. A function is read on a grid of each face whose
squares are at most a radius wide, and is linear between; where it is 0 there are no points.

Raises ValueError as scatter_uniform(), and for a radius that is not above 0 and finite or of which
more than 2^31 points would come, and faces too sheared. Some 12 microseconds a point.
)";

constexpr const char* kClosestDoc =
    R"(The closest point of the limit surface, itself and not of polygons, for each of (n, 3) points.

Boundaries, creases and corners are part of the surface. max_distance leaves out what is farther.
facing, (n, 3) or (3,) directions, accepts only feet whose normal is within max_angle (radians) of
them; a foot is where the distance over its smooth sheet (boundaries and infinitely sharp edges end
one) is smallest in its neighbourhood. progress, a function, is called now and then with the part
done, 0 to 1; what it raises ends the call.

Returns Hits: .face (n,) int32, .uv (n, 2), .position and .normal (n, 3), which are what evaluate()
gives there, and .distance (n,). Where there is none face is -1 and the rest NaN.

Error: the distance is within 1e-12 of the cage's diagonal of the true minimum, for points within
1,000 diagonals. Branch and bound over control hulls, then Newton's iteration where the distance is
convex; microseconds a point. The first call builds a search tree that is kept until
set_positions().

Raises ValueError for other shapes, points that are not finite and options without meaning.
)";

constexpr const char* kRayCastDoc =
    R"(The first point at which each ray meets the limit surface, from either side.

origins and directions, (n, 3) each; directions need not be unit vectors. Rays that graze the
surface within 1e-12 of the cage's diagonal hit it; none slip through between faces. Returns Hits
(see closest()); .distance counts along the normalised direction, is at least 0 and at most
max_distance. Error of hits: 1e-12 of the diagonal, for origins within 1,000 diagonals.

Raises ValueError for other shapes, rows that are not finite and directions without length.
)";

constexpr const char* kRayCastAllDoc =
    R"(All points at which each ray meets the limit surface, sorted along it.

As ray_cast(), but RayHits: the fields of Hits with one row for each hit, and .offsets (n + 1,)
int64: the hits of ray i are rows offsets[i] to offsets[i + 1] - 1. A hit on the border of several
faces counts once; of a stretch on which a ray runs within the surface, the beginning on each
patch is given.
)";

constexpr const char* kTessellateDoc =
    R"(Watertight polygons on the limit surface: 2^levels x 2^levels quads a face.

Each sub-face of an n-gon gets half as many a side, so levels >= 1 where there are n-gons. levels
may be (F,) integers, one for each face of the mesh (those of refused faces mean nothing): an edge
then has 2^level segments for the largest level of its faces, and coarser faces pass over to it by
smaller quads and triangles.

Returns Tessellation:
    .positions .normals (n, 3), .locations: of the points, each of which exists once
    .faces (m, 4) int32: the polygons; those of triangles end in -1
    .face_sizes (m,) .face_vertices (k,) int32: the same without such ends
    .base_face .ptex_face (m,) int32: the mesh's face, and the Ptex face, that a polygon lies on
    .corner_uv (k, 2) float32: of the polygons' corners on their own Ptex face, exactly
    .corner_locations: the same as Locations
    .corner_normals (k, 3): with corner_normals=True, else None; as seen from the polygon's own
        face, so one-sided at creases
Normals are always finite: at irregular vertices without one they are the third column of frames().
progress: called with the part that is done, 0 to 1. ValueError names the first face whose level is
not 0 (n-gons: 1) to 12.
)";

constexpr const char* kLevelsWithinDoc =
    R"(Levels for tessellate(), as low as keeps polygons within `tolerance` of the surface.

That is measured, not bounded: between the surface and either way of cutting polygons into triangles,
at the middles of sides, diagonals and quads and at 8 or more places along each side of a Ptex face,
along the surface's normal; on borders and infinitely sharp edges the sides' distance as well.
Neighbours are raised until levels differ by 2 at most across an edge.

Returns FaceLevels: .levels (F,) int32, .measure (F,): the deviation at that level or, where a
neighbour raised it, at a lower one; above `tolerance` where the level `most` is too low. 0 and NaN
for refused faces. ValueError unless tolerance > 0 and most is 1 to 12.
)";

constexpr const char* kLevelsOfLengthDoc =
    R"(Levels for tessellate(), as low as keeps sides of polygons no longer than `length`.

With matrix (4, 4) that is a length in a picture: matrix @ (x, y, z, 1) are homogeneous coordinates
there, and what has w < nearest is not seen, so has no length. Lengths are measured between places
at eighths of each side of a Ptex face. Neighbours are raised until levels differ by 2 at most
across an edge.

Returns FaceLevels: .levels (F,) int32, .measure (F,): the longest side at that level or, where a
neighbour raised it, at a lower one; above `length` where the level `most` is too low. 0 and NaN for
refused faces. ValueError unless length > 0 and most is 1 to 12.
)";

constexpr const char* kRasterizeDoc =
    R"(Where the texels of an image lie on the surface: the UV map inverted on its limit.

Parameters
----------
width, height : int, 1 to 65,536
tile : (int, int)
    The image covers [i, i + 1] x [j, j + 1] of the map: UDIM tile 1001 + i + 10 j.
margin : float
    Texels outside the map's image whose centre is no farther from it than so many texels get the
    location on its border that is nearest.
threads : int
progress : function of the part that is done, 0 to 1, optional

Returns
-------
Texels
    Sorted by row (y), then by column (x), with y upwards as in Blender's images. Texel (x, y)'s
    centre is tile + ((x + 0.5) / width, (y + 0.5) / height) on the map.
    .x .y : (n,) int32
    .face : (n,) int32, .uv : (n, 2)
        The location, exact to 1e-12 of the diagonal of the box around the map's values and (0, 0).
    .inside : (n,) bool
        False for texels of the margin.
    .overlap : (n,) bool
        Several places of the surface lie there; that with the lowest Ptex face is given, among
        those of one face that with the lowest v, then u.
    .flipped : (n,) bool
        The map is mirrored there.

No texel is lost on edges that faces share. Faces whose image has no area cover none.

Raises ValueError for data of other than two columns, and for sizes out of range.
)";

constexpr const char* kLocateDoc =
    R"(Which places of the surface lie at points of the UV map: (n, 2) float.

Returns MapLocations: .face (n,) is -1 and .uv (n, 2) NaN where the map does not cover the point;
.overlap and .flipped as rasterize() has them. A point on the map's border counts as covered.

Raises ValueError for data of other than two columns, and naming the first row that is not finite.
)";

}  // namespace limitsurf::python
