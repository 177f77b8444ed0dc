// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

constexpr const char* kSubdividedFacesDoc =
    R"(Which face of a subdivided control mesh lies where on the mesh that it was made of.

The subdivided mesh may have any shape (it was sculpted, say) and number its vertices as it likes.
Its faces must be those of the base subdivided 0 to 12 times, in Blender's order (Subdivision
Surface, Multiresolution) or in OpenSubdiv's (corner by corner, recursively), and share vertices as
those do. All of that is checked; positions are not looked at.

    faces = limitsurf.SubdividedFaces(base.mesh, sculpted.mesh)
    there = faces.locate(face, uv)                  # the same places on the subdivided mesh
    sculpted.evaluate(there.face, there.uv)

Raises
------
MeshError
    'structures do not match: ...', naming the first face that does not fit.
)";

constexpr const char* kLocateOnSubdividedDoc =
    R"(The same places on the subdivided mesh, as Locations: exactly, as (u, v) are scaled by a power
of two. Of places between two of its faces one is given.)";

constexpr const char* kVectorDisplacementDoc =
    R"(How to get from this surface to another one of the same structure, at the same places.

Parameters
----------
target : LimitSurface
    Of a mesh with the same faces, or with those of this one's mesh subdivided (SubdividedFaces tells
    what counts), in any pose. Both surfaces are taken in their present pose and in one space: a
    target that lies elsewhere is brought here by set_positions().
face, uv : as in evaluate()
    Locations on this surface.
frames : (n, 3, 3) array of float, optional
    Columns tangent, bitangent, normal of each location, orthonormal: those of tangent_frames() or
    frames(). Vectors are then given by their components along tangent, normal, bitangent: the order
    in which Blender's Vector Displacement node reads red, green, blue in tangent space.
progress : callable, optional
    Called with the part of the work that is done, 0 to 1.

Returns
-------
(n, 3) float64: target - self; error 3e-13 of the diagonal of both meshes.

Raises
------
MeshError
    Where the structures do not match, and where a face of the target has no limit surface.
)";

constexpr const char* kScalarDisplacementDoc =
    R"(How far along the exact normals another surface of any structure lies.

The nearest point at which the line along the normal meets the target's limit surface counts.

Parameters
----------
target : LimitSurface
    In the same space.
face, uv : as in evaluate()
max_distance : float
    Nothing further away counts.
direction : 'both', 'outward' or 'inward'
progress : callable, optional
    Called with the part of the work that is done, 0 to 1.

Returns
-------
(n,) float64: distances, negative inward; NaN where nothing is met.
)";

constexpr const char* kDisplacedDoc =
    R"(Points of the surface, moved: reads a displacement map back.

    values = limitsurf.bilinear(pixels, uv_map.evaluate(face, uv).value)
    moved = surface.displaced(face, uv, values[:, :3], frames=frames)

Parameters
----------
face, uv : as in evaluate()
values : (n, 3) or (n,) array of float
    Vectors, or distances along the normals: as vector_displacement() and scalar_displacement() give
    them.
frames : (n, 3, 3) array of float, optional
    Those in which the vectors' components are given (in the order tangent, normal, bitangent);
    without them vectors are taken as they are.

Returns
-------
(n, 3) float64.
)";

}  // namespace limitsurf::python
