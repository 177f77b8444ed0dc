// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

constexpr const char* kFilteredImageDoc =
    R"(An image that can be looked up through footprints of any size and shape without aliasing.

Parameters
----------
pixels : (h, w, c) array of float
    Finite float32, c = 1 to 4; rows from the bottom, as Blender's Image.pixels has them. With four
    channels the last is alpha; others have none.
extension : 'clip', 'extend', 'repeat' or 'mirror'
    What lies outside [0, 1] x [0, 1]: nothing (0, transparent), the border's pixels, the image again,
    or mirrored and again.
premultiplied : bool
    Whether the colours come multiplied by alpha, as in Blender's float images; straight ones, as in
    its 8 bit images, are multiplied before they are filtered, so that what is transparent brings no
    dark fringe.

Keeps a copy and the halvings of it: 1.34 times the pixels' float32 size (8K x 8K x 4: 1.4 GB).

Raises
------
ValueError
    For other shapes, no pixels, and naming the first pixel that is not finite.
)";

constexpr const char* kSampleDoc =
    R"(The image at each of n places as a texel sees it: (n, c) float32, straight alpha.

Parameters
----------
st : (n, 2) array of float
    (0, 0) is the image's lower left corner, (1, 1) its upper right one. A row of NaN is nowhere:
    all channels are 0 there.
footprint : (n, 2, 2) array of float
    [[ds/dx, ds/dy], [dt/dx, dt/dy]]: by how much st moves from texel to texel, along x and along y.
    Vectors longer than four images count as four.

Where the footprint is at most a pixel long the image is interpolated linearly. From a length of one
and a half the filter is an elliptical weighted average (Greene & Heckbert 1986) with a bell that has
half a texel for standard deviation, on the halving of the image that suits the ellipse's short axis;
the long one may be 32 times as long, beyond it the short one is widened. Between a pixel and one and
a half the two are mixed.

Values are within 0.15 (mostly 0.05) of the exact integral of the image under a Gaussian of that
size, for pixels from 0 to 1 and footprints up to 32 times as long as wide (not near borders that
'extend' continues: what it repeats is the border of a halving). Some 0.05 to 0.5 microseconds a row
and core.
)";

constexpr const char* kProjectDoc =
    R"(Where a projector's image falls on texels of the surface's UV map: Projection.

Parameters
----------
uv_map : SurfaceData
    Two columns, of this surface: face_varying() of a UV map.
face, uv : (n,) or one int; (n, 2)
    The locations under the texels' centres, as uv_map.rasterize() finds them.
matrix : (4, 4) array of float
    From the surface's own coordinates to clip space, as OpenGL and Blender have it: projection @
    view @ object. With (x, y, z, w) = matrix @ (position, 1) the image is x/w and y/w from -1 to 1;
    w is above 0 in front of the eye; z/w grows from -1 on the near plane to 1 on the far one. Any
    perspective, orthographic or planar projector, shifted and skewed ones included.
texel : (2,) floats
    Size of a texel in the UV map's units: (1 / width, 1 / height).
facing : (start, end)
    Angles in radians between the normal and the direction towards the eye: up to `start` the weight
    is 1, it falls smoothly to 0 at `end`. At irregular vertices that have no normal: frames()'s.
two_sided : bool
    Whether the back is projected on as well: angles are taken to the nearer of both sides.
occlusion : bool
    Whether the surface hides what is behind it: one limit ray for each sample.
samples : 1, 4 or 16
    Rays a texel, in a square grid over it, so that the borders of shadows are smooth. Places beyond
    the texel's own Ptex face are moved to the face's border.
bias : float or None
    How far from the surface, along its normal, rays begin; None: 1e-9 of the cage's diagonal, a
    thousand times the error of rays. Sheets nearer to each other than that do not hide each other.
soft_edge : float
    Over this part of the image's width and height, 0 to 1/2, the weight rises from its borders on.
frame : bool
    Whether the weight is 0 outside the image, and along its border the part of the texel that is
    inside. False: everywhere in front of the eye, for images that extend, repeat or mirror.
depth : (near, far) or None
    Bounds of z/w; None: all that is in front of the eye. What is nearer than near neither receives
    the image nor hides anything, as in a render with clipping.
world : (4, 4) array of float or None
    From the surface's own space to the one in which angles are measured, where the object's scale
    is not uniform.
threads, progress
    As for closest().

Returns Projection: .st (n, 2), (0, 0) at the image's lower left corner; .footprint (n, 2, 2),
[[ds/dx, ds/dy], [dt/dx, dt/dy]] from texel to texel; .weight (n,), 0 to 1. Where nothing can be seen
(not in front of the eye) st is NaN, footprint 0 and weight 0. Pass st and footprint on to
FilteredImage.sample(), preferably with extension 'extend', since .weight ends at the frame.

st is exact but for rounding, and so is the footprint: from first derivatives of the surface, the map
and the projection. Where those have no limit (at irregular vertices), or surface or map are singular,
they are taken 1/1024 of the way to the face's centre; where the map is singular there too the
footprint is 0. Vectors longer than four images are shortened to four.

Raises ValueError for a matrix that is not finite or singular, options without meaning, and a map that
does not have two columns or is another surface's; LocationError and MeshError as evaluate().
Some 1 to 3 microseconds a texel and ray.
)";

constexpr const char* kProjectAlongNormalsDoc =
    R"(Where rays along this surface's normals meet another one, in that one's UV map: Projection.

Parameters
----------
uv_map, face, uv, texel, threads, progress
    As for project().
source : LimitSurface
    The surface that carries the image. May be this one: then every ray ends where it begins.
source_map : SurfaceData
    Its UV map, two columns.
max_distance : float
    Rays go so far, measured in the world.
direction : 'both', 'outward' or 'inward'
    Along the normal, against it, or whichever way meets the source first.
transform : (4, 4) array of float or None
    From this surface's space into the source's; None: they are the same.
world : (4, 4) array of float or None
    From this surface's space to the one in which normals are perpendicular and distances are
    measured, where the object's scale is not uniform; None: its own.

Returns Projection: .st is source_map at the hit, .footprint how it moves from texel to texel, as the
ray's origin and direction do (first and second derivatives of this surface, first ones of the
source), .weight 1 where the source is met, else 0, with st NaN and footprint 0. The first hit counts,
from either side. Where derivatives have no limit, see project(); where the ray is tangent to the
source or its map is singular the footprint is 0. Vectors longer than four images are shortened to
four.

Raises ValueError as project(), and for a max_distance below 0 and a transform that is not finite or
singular.
)";

constexpr const char* kEyeIsInsideDoc =
    R"(Whether the eye of a perspective projector (matrix as for project()) is inside the surface.

26 fixed rays go out from it, to the corners, edges and faces of a cube. A closed surface (every edge
has two faces, none is refused) has it inside if more than half of them first meet a back; an open one
if all of them do. A room whose normals point inwards has nobody inside, and False is the answer for
an orthographic projector, whose eye is at infinity.

Raises ValueError for a matrix that is not finite or singular.
)";

constexpr const char* kBlendOverDoc =
    R"(Pixels above laid over pixels below: (n, 4) float32.

Parameters
----------
below, above : (n, 4) arrays of float32
    Red, green, blue, alpha; `above` has straight alpha.
weight : (n,) array of float
    0 to 1; multiplies above's alpha. Where it is 0 the result is below, to the last bit.
mode : 'mix', 'add' or 'multiply'
    'mix': alpha over (Porter & Duff 1984). The others blend the colours where both cover, as W3C's
    Compositing and Blending 1 says: (1 - alpha below) above + alpha below (below + above), or
    (below times above), is what is laid over.
premultiplied : bool
    Whether below, and the result, have colours multiplied by alpha, as in Blender's float images.

Raises ValueError for other shapes and naming the first weight that is not in [0, 1].
)";

constexpr const char* kBoxSidesDoc =
    R"(The six planar projectors of a box: (6, 4, 4) matrices for project(), for +x, -x, +y, -y, +z, -z.

matrix, (4, 4), takes the surface's own coordinates to the box's, in which the box reaches from -1 to
1. Seen from outside, on each side the image is upright (z up on the four walls, y up above and below)
and not mirrored.

Raises ValueError for a matrix that is not finite or singular.
)";

constexpr const char* kBoxWeightsDoc =
    R"(How much each side of a box, in the order of box_sides(), counts for surface normals: (n, 6).

normals, (n, 3), are in the surface's own coordinates and matrix, (4, 4) or None, takes those to the
box's. blend, 0 to 1: with 0 the side that the normal points to most takes all, with 1 sides count in
proportion to the normal's components, and between sides count from (1 - blend) times the largest on.
Rows add up to 1. Of equal sides with blend 0 the first is taken.

Raises ValueError for a blend outside [0, 1], a matrix that is not finite or singular, and naming the
first normal that is not finite or 0.
)";

}  // namespace limitsurf::python
