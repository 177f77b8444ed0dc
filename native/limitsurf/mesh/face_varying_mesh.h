// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/mesh/interpolation.h"
#include "limitsurf/mesh/topology.h"

namespace limitsurf {

/// A face-varying channel as a control mesh of its own: the limit surface of `mesh`, with the
/// channel's values for positions, is the channel's limit.
///
/// It has the faces of the surface's mesh, corner by corner, and one vertex for each value that a
/// vertex of that mesh takes. An edge is a seam if the values of its two faces differ at one of its
/// ends. A seam becomes two boundaries; all other edges keep their sharpness. Where a value lies in
/// several fans of faces around its vertex, these fans share a vertex, which is pinned, unless
/// OpenSubdiv takes them for different values (value_vertices.cpp says when). Other vertices that
/// the rules of `Interpolation` and of the surface's boundary pin get infinite sharpness, so that
/// the mesh's own boundary rule is always Boundary::smooth. What edges beyond a seam do to the
/// decay of sharpness, which no mesh by itself can represent, is said in `seams`.
struct FaceVaryingMesh {
  ControlMesh mesh;         ///< all positions are 0
  std::vector<int> values;  ///< per vertex of `mesh`: the row of its value
  /// What the sharpness beyond seams does to its vertices: Topology takes it.
  SeamSharpness seams;
};

/// `indices` holds the value of each corner of the faces of `mesh`, one face after the other.
/// Faces that `topology`, that of `mesh`, refuses become holes.
///
/// Throws MeshError where `indices` has another size than the mesh has corners, and for an index
/// that is not below `value_count`, naming it and its corner.
FaceVaryingMesh faceVaryingMesh(const ControlMesh& mesh, const Topology& topology,
                                const std::vector<std::int64_t>& indices, std::int64_t value_count,
                                Interpolation interpolation);

}  // namespace limitsurf
