// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::python {

constexpr const char* kSubdividedFacesDoc =
    R"(The places of the faces of a subdivided control mesh on the mesh that was subdivided, the base.

The subdivided mesh may have any shape (it may have been sculpted) and any order of vertices. Its faces
must be those of the base subdivided 0 to 12 times, in Blender's order (Subdivision Surface,
Multiresolution) or in OpenSubdiv's (corner by corner, recursively), and must share vertices in the same
way. All this is checked; positions are not used. These places cannot be copied or pickled.

    faces = limitsurf.SubdividedFaces(base.mesh, sculpted.mesh)
    there = faces.locate(face, uv)                  # the same places on the subdivided mesh
    sculpted.evaluate(there.face, there.uv)

Raises
------
MeshError
    'structures do not match: ...', naming the first face that does not fit.
)";

constexpr const char* kLocateOnSubdividedDoc =
    R"(The same places on the subdivided mesh: Locations.

They are exact, since (u, v) are scaled by a power of two. A place between two faces is assigned to one of
them. (u, v) must lie in [0, 1]. Raises LocationError for a face that is not one of the base's Ptex faces.)";

constexpr const char* kVectorDisplacementDoc =
    R"(The displacement from this surface to another one of the same structure, at the same places.

Parameters
----------
target : LimitSurface
    A surface whose mesh has the same faces, or those of this mesh subdivided (SubdividedFaces says
    what is required), in any pose. Both surfaces are used in their present pose and in the same space;
    set_positions() moves a target into this space.
face, uv : as in evaluate()
    Locations on this surface.
frames : (n, 3, 3) array of float, optional
    An orthonormal frame for each location, with the columns tangent, bitangent and normal: those of
    tangent_frames() or frames(). Vectors are then returned as their components along tangent, normal
    and bitangent, the order in which Blender's Vector Displacement node reads red, green and blue.
progress : callable, optional
    It is called with the part of the work that is done, 0 to 1.

Returns
-------
(n, 3) float64
    target - self. Error bound: 3e-13 of the diagonal of the box around both meshes.

Raises
------
MeshError
    If the structures do not match, and for a face of the target that has no limit surface.

Cost: two evaluations a location.
)";

constexpr const char* kScalarDisplacementDoc =
    R"(The distance of another surface, of any structure, along this surface's exact normals.

It is measured to the nearest point at which the line along the normal meets the target's limit surface.

Parameters
----------
target : LimitSurface
    The other surface, in the same space.
face, uv : as in evaluate()
    Locations on this surface.
max_distance : float
    Points farther away are not found.
direction : 'both', 'outward' or 'inward'
progress : callable, optional
    It is called with the part of the work that is done, 0 to 1.

Returns
-------
(n,) float64
    Distances, negative inward; NaN where the line does not meet the target.

Raises ValueError for a max_distance that is NaN or negative. Cost: an evaluation, and a ray in each
direction.
)";

constexpr const char* kDisplacedDoc =
    R"(The points of the surface moved by displacements: reads a displacement map back.

    values = limitsurf.bilinear(pixels, uv_map.evaluate(face, uv).value)
    moved = surface.displaced(face, uv, values[:, :3], frames=frames)

Parameters
----------
face, uv : as in evaluate()
values : (n, 3) or (n,) array of float
    Vectors, or distances along the normals, as vector_displacement() and scalar_displacement() return
    them.
frames : (n, 3, 3) array of float, optional
    The frames in which the vectors are given by their components (in the order tangent, normal,
    bitangent). Without frames the vectors are given in space.

Returns
-------
(n, 3) float64.
)";

}  // namespace limitsurf::python
