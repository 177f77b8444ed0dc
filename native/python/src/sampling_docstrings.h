// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

constexpr const char* kAreaDoc =
    R"(The area of the limit surface, in squared units of length, without refused faces.

Returns a float. With error=True, returns a tuple (area, error) of two floats: error is an estimate of
the area's error, in the same unit. It is below 1e-9 of the area, unless du x dv vanishes inside faces,
as along the folds of a mesh that is folded over in a plane; on such a surface the cost stays bounded and
the error grows. A surface that is collapsed onto a line or a point has the area 0 up to that error.

Cost: O(faces), whatever the positions are.
)";

constexpr const char* kScatterJitteredDoc =
    R"(Stratified random locations: one in each of per_side x per_side equal squares of every Ptex face.

Figure 1 of Lacewell & Burley 2007 shows such locations. Returns Locations (.face, .uv) in face order;
refused faces have none. A seed (0 to 2^64 - 1) gives the same locations on every machine.

faces, (k,) integers, are the Ptex faces on which locations are wanted: the same as without faces, in
the order of this array.

Raises ValueError for a per_side below 1, and LocationError naming the first of faces that is no Ptex
face. Cost: O(locations).
)";

constexpr const char* kScatterUniformDoc =
    R"(Independent random locations, uniform by the area of the surface, or by area times density.

The distribution is exact, also within each face: it follows the area, not (u, v). Returns Locations
(.face, .uv) in random order; the first n of a longer sequence are the locations for a count of n. A
seed (0 to 2^64 - 1) gives the same locations on every machine and with any number of threads.

density is None; or (V,) weights of the vertices, bilinear on each Ptex face; or a function that takes
(face, uv), arrays (n,) int32 and (n, 2) float64, and returns (n,) weights. Weights are relative, finite
and at least 0; no location lies where the weight is 0. A function may be below 0 by rounding, by 1e-12
of the largest weight that the same call of it returns. The function must not call set_positions(). The
more its largest value exceeds its mean, the longer the call takes. progress is a function that is
called from time to time with the part of the work that is done, 0 to 1; an exception that it raises
ends the call.

Raises ValueError for a negative count, for a density that is negative, not finite, of another shape or
0 everywhere, for a function so far below its largest value or its limits that none of 33 million
candidates in succession is accepted, and for a surface without area. Cost: about 0.2 microseconds a location. The first call
builds a table that is kept until set_positions().

density_limits, for a function alone, are numbers that it does not exceed: (f,) one for each Ptex face,
or (f, side, side) one for each of the equal squares [face, row along v, column along u], where side is
a power of two up to 1024. They save the candidates that would be rejected: with a function that is
0 outside of a thousandth of the surface a call takes a hundredth of the time. SurfaceData.bounds()
and FilteredImage.bounds() give such numbers. The closer they are to the function, the faster the
call. Limits must be finite and at least 0 on faces that have
a surface. A location where the function exceeds its limit raises ValueError, if it is met.
)";

constexpr const char* kScatterBlueNoiseDoc =
    R"(Random points that keep a distance from each other: blue noise, by Poisson-disc sampling.

Exactly one of count and radius must be given. Two points conflict if the chord between them is shorter
than the radius and the angle between their normals is below 90 degrees, so that points on the two sides
of a thin sheet do not conflict. For a radius the points are maximal: no room for another point remains
that is wider than 1/512 of the radius. For a count there are exactly as many points, as far apart as
such random points can be. Returns BlueNoise: .face and .uv in face order, and .radius, the distance
that the points keep.

seed, density and progress are those of scatter_uniform(). With a density the radius of a point is
proportional to 1 / sqrt(density / largest density), and two points keep the mean of their radii. A
density function is read on a grid of each face whose squares are at most a radius wide, and
interpolated; no point lies where it is 0. density_limits are those of scatter_uniform(): where they are
0 the grid is not read, and all else is the same.

The method is that of White, Cline & Egbert ("Poisson Disk Point Sets by Hierarchical Dart Throwing",
2007) on the limit surface. Raises ValueError as scatter_uniform() does, for a radius that is not finite
and above 0 or would lead to more than 2^31 points, where the density is above 0 only on parts so small
that no point is found, and for faces that are sheared too strongly. Cost: about 4 microseconds a point
on one core.
)";

}  // namespace limitsurf::python
