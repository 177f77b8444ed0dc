// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

constexpr const char* kFilteredImageDoc =
    R"(An image that can be sampled under footprints of any size and shape without aliasing.

It cannot be copied or pickled.

Parameters
----------
pixels : (h, w, c) array of float
    Finite float32, c = 1 to 4, with rows from the bottom, as in Blender's Image.pixels. The last of
    four channels is alpha; images of fewer channels have none.
extension : 'clip', 'extend', 'repeat' or 'mirror'
    What lies outside [0, 1] x [0, 1]: nothing (0, transparent), the pixels of the border, the
    repetition of the image, or its mirrored repetition.
premultiplied : bool
    Whether the colours are already multiplied by alpha, as in Blender's float images. Straight
    colours, as in its 8 bit images, are multiplied before they are filtered, so that transparent
    pixels leave no dark fringe.

A copy of the image and smaller copies of it (mipmap levels) are kept: 1.34 times the size of the pixels as
float32 (1.4 GB for 8K x 8K x 4).

Raises
------
ValueError
    For an array of another shape or without pixels, and naming the first pixel that is not finite.
)";

constexpr const char* kImageBoundsDoc =
    R"(Bounds of the image in each of n boxes: (n, 2, c) float32, the least and the largest values.

boxes : (n, 2, 2) array of float
    [[s, t], [s, t]]: the lower left corner of each box, and the upper right one. Where a box has a NaN
    the bounds are NaN.

They hold for what sample() returns in a box for footprints of 0: they are those of the pixels that it
interpolates there, and wider by a rounding error of 1e-6 of the largest of these pixels. In boxes of
many pixels some pixels close to the box count as well: boxes are taken to be up to an eighth longer.

Raises ValueError for images with alpha (4 channels), for arrays of other shapes, and naming the first
row that is infinite or has a lower corner above the upper one. Cost: O(pixels) for a call, and then
0.1 to 1 microsecond a box.
)";

constexpr const char* kSampleDoc =
    R"(The image under the footprint at each of n places: (n, c) float32, with straight alpha.

Parameters
----------
st : (n, 2) array of float
    (0, 0) is the lower left corner of the image, (1, 1) the upper right one. Where a row has a NaN all
    channels are 0.
footprint : (n, 2, 2) array of float
    [[ds/dx, ds/dy], [dt/dx, dt/dy]]: the steps of st from texel to texel, along x and along y. Vectors
    longer than four images are shortened to four.

Under a footprint of at most a pixel's length the image is interpolated bilinearly. From a length of one
and a half pixels on, the filter is an elliptical weighted average (Greene & Heckbert: "Creating Raster
Omnimax Images from Multiple Perspective Views Using the Elliptical Weighted Average Filter", 1986) with
a standard deviation of half a texel, on the smaller copy of the image that suits the short axis of the
ellipse. The long axis may be 32 times as long; if it is longer, the short axis is widened. Between the
two lengths both results are mixed.

For pixels from 0 to 1, values are within 0.22 (mostly 0.05; measured) of the exact integral of the image
under a Gaussian of that size, for footprints up to 32 times as long as wide. This does not hold near
borders that 'extend' continues, because the border of a halved image is repeated there. Cost: 0.05 to
0.5 microseconds a row on one core. Raises ValueError for arrays of other shapes and naming the first row
that is not finite.
)";

constexpr const char* kProjectDoc =
    R"(Projects an image onto the texels of the surface's UV map: Projection.

Parameters
----------
uv_map : SurfaceData
    A UV map of this surface, with two columns: face_varying() makes it.
face, uv : (n,) or one int; (n, 2)
    The locations of the centres of texels, as uv_map.rasterize() finds them.
matrix : (4, 4) array of float
    From the surface's own coordinates to clip space, in OpenGL's and Blender's convention: projection @
    view @ object. With (x, y, z, w) = matrix @ (position, 1) the image is (x/w, y/w), from -1 to 1; w is
    positive in front of the eye; z/w grows from -1 on the near plane to 1 on the far plane. Every
    perspective, orthographic or other parallel projector is possible, also shifted and skewed ones.
texel : (2,) floats
    The size of a texel in units of the UV map: (1 / width, 1 / height).
facing : (start, end)
    Angles in radians between the normal and the direction towards the eye: the weight is 1 up to
    `start` and falls smoothly to 0 at `end`. The normal is that of frames() at irregular vertices
    without one.
two_sided : bool
    Whether the back receives the image as well: angles are measured on the side that faces the eye.
occlusion : bool
    Whether the surface hides what lies behind it; a ray on the limit surface tests each sample.
samples : 1, 4 or 16
    The number of rays for each texel, in a square grid over it, so that the borders of shadows are
    smooth. Places beyond the texel's own Ptex face are moved to the border of the face.
bias : float or None
    The distance from the surface, along its normal, at which rays begin. None means 1e-9 of the control
    mesh's diagonal, a thousand times the error of rays. Sheets that are closer to each other than that
    do not hide each other.
soft_edge : float
    The width, 0 to 1/2 of the image, of the zone inside its borders over which the weight rises.
frame : bool
    Whether the weight is 0 outside the image; along the image's border it is then the part of the texel
    that lies inside. Use False for images that extend, repeat or mirror.
depth : (near, far) or None
    The visible range of z/w; None means everything in front of the eye. What lies in front of `near`
    neither receives the image nor hides anything, as in a render with clipping.
world : (4, 4) array of float or None
    From the surface's own space to world space, in which angles are measured; needed if the object's
    scale is not uniform.
threads, progress
    As for closest().

Returns Projection: .st (n, 2), with (0, 0) at the lower left corner of the image; .footprint (n, 2, 2),
[[ds/dx, ds/dy], [dt/dx, dt/dy]], the steps from texel to texel; and .weight (n,), 0 to 1. For a texel
that is not in front of the eye st is NaN, and footprint and weight are 0. Pass st and footprint to
FilteredImage.sample(), preferably with extension 'extend', because the weight ends at the frame.

st and the footprint are exact except for rounding: they come from first derivatives of the surface, the
map and the projection. Where these have no limit (at irregular vertices), or the surface or the map is
singular, those at 1/1024 of the way towards the face's centre are used; where the map is singular there
too, the footprint is 0. Vectors longer than four images are shortened to four.

Raises ValueError for a matrix that is singular or not finite, for options out of range, and for a map
that has other than two columns or another number of Ptex faces than the surface; LocationError and
MeshError as evaluate(). A map of another surface with as many Ptex faces is not noticed. Cost: 1 to 3
microseconds for each texel and ray.
)";

constexpr const char* kProjectAlongNormalsDoc =
    R"(Projects from the UV map of another surface along this surface's normals: Projection.

Rays leave this surface along its normals; .st is the value of the other surface's map at their first hit.

Parameters
----------
uv_map, face, uv, texel, threads, progress
    As for project().
source : LimitSurface
    The surface that carries the image. If it is this one, every ray ends where it begins.
source_map : SurfaceData
    The UV map of the source, with two columns.
max_distance : float
    The largest length of a ray, measured in world space.
direction : 'both', 'outward' or 'inward'
    'outward' is along the normal, 'inward' against it; 'both' takes the hit that is nearer.
transform : (4, 4) array of float or None
    From this surface's space to the source's; None means that they are the same.
world : (4, 4) array of float or None
    From this surface's space to world space, in which normals are perpendicular and distances are
    measured; needed if the object's scale is not uniform. None means this surface's own space.

Returns Projection: .st is the value of source_map at the hit; .footprint the steps of st from texel to
texel, as the ray's origin and direction change (from first and second derivatives of this surface, and
first derivatives of the source); .weight is 1 for a hit and 0 otherwise, with st NaN and footprint 0. The
first hit counts, from either side. Where derivatives have no limit they are taken as by project(). Where
the ray is tangent to the source, or its map is singular, the footprint is 0. Vectors longer than four
images are shortened to four.

Raises ValueError as project() does, for a max_distance below 0, for a transform that is singular or not
finite, and for one that takes places too far from the source.
)";

constexpr const char* kEyeIsInsideDoc =
    R"(Whether the eye of a perspective projector (matrix as for project()) is inside the surface.

26 fixed rays leave the eye towards the corners, edges and faces of a cube. The eye is inside a closed
surface (every edge has two faces, and no face is refused) if more than half of the rays first hit its
back, and inside an open surface if all of them do. An eye in a room whose normals point inwards is
therefore not inside. The result is False for an orthographic projector, whose eye is at infinity.

Raises ValueError for a matrix that is singular or not finite. Cost: 26 rays.
)";

constexpr const char* kBlendOverDoc =
    R"(Pixels `above` composited over pixels `below`: (n, 4) float32.

Parameters
----------
below, above : (n, 4) arrays of float32
    Red, green, blue and alpha; `above` has straight alpha.
weight : (n,) array of float
    0 to 1; it multiplies the alpha of `above`. Where it is 0 the result is `below`, to the last bit.
mode : 'mix', 'add' or 'multiply'
    'mix' is the operator "over" (Porter & Duff: "Compositing Digital Images", 1984). The other modes
    blend the colours where both cover, as in W3C's "Compositing and Blending Level 1": the colour that
    is laid over is (1 - alpha of below) above + (alpha of below) B, where B is below + above for 'add'
    and below * above for 'multiply'.
premultiplied : bool
    Whether `below` and the result have colours multiplied by alpha, as in Blender's float images.

Raises ValueError for arrays of other shapes and naming the first weight that is not in [0, 1].
)";

constexpr const char* kBoxSidesDoc =
    R"(The six parallel projectors of a box: (6, 4, 4) matrices for project(), for +x, -x, +y, -y, +z, -z.

matrix, (4, 4), takes the surface's own coordinates to those of the box, which reaches from -1 to 1. Seen
from outside, the image on each side is upright (z is up on the four walls, y is up on +z and -z) and not
mirrored.

Raises ValueError for a matrix that is singular, not finite or not affine.
)";

constexpr const char* kBoxWeightsDoc =
    R"(The weights of a box's sides, in the order of box_sides(), for surface normals: (n, 6).

normals, (n, 3), are in the surface's own coordinates; matrix, (4, 4) or None, takes these to those of the
box. With blend 0 the side with the largest component of the normal has all the weight, the first of equal
ones. With blend 1 the weights are proportional to the components. Between, a side has weight if its
component exceeds (1 - blend) times the largest. Each row adds up to 1.

Raises ValueError for a blend outside [0, 1], for a matrix that is singular, not finite or not affine, and
naming the first normal that is 0 or not finite.
)";

}  // namespace limitsurf::python
