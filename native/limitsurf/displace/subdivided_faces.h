// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/mesh/control_mesh.h"
#include "limitsurf/surface/location_batch.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The order in which a program that subdivides a mesh numbers the resulting faces. Those of one
/// face always follow each other, and the faces keep the order of the mesh.
enum class FaceOrder {
  blender,     ///< that of Subdivision Surface and Multiresolution: inner faces, then strips
  opensubdiv,  ///< corner by corner, recursively within each child
};

constexpr int kMostSubdivisions = 12;

/// The places of the faces of a subdivided control mesh on the mesh that was subdivided, the base.
///
/// The subdivided mesh may have any shape, and any order of vertices. Its faces must be those of
/// the base, subdivided `levels()` times, in one of the known orders, and must share vertices in
/// the same way. At 0 levels both meshes have the same faces. All this is checked when the object
/// is made; nothing is inferred from positions.
class SubdividedFaces {
 public:
  /// Throws MeshError, "structures do not match: ...", for a number of faces that no subdivision of
  /// the base has, and naming the first face whose size or whose shared vertices differ from those
  /// of the base's subdivision. Cost: O(faces), with 16 temporary bytes a face.
  SubdividedFaces(const ControlMesh& base, const ControlMesh& subdivided);

  int levels() const { return levels_; }
  /// The order of the faces. Up to one level all orders are the same, and blender is returned.
  FaceOrder order() const { return order_; }
  int baseFaceCount() const { return static_cast<int>(parts_.size()); }

  /// The same place on the subdivided mesh. It is exact, since (u, v) are scaled by a power of two.
  /// A place between faces is assigned to the face towards (1, 1). `at.face` must be one of the
  /// base's Ptex faces.
  Location locate(const Location& at) const;
  std::vector<Location> locate(const LocationBatch& at, int threads = 0) const;

 private:
  /// A Ptex face of the base mesh.
  struct Part {
    int first;  ///< the subdivided mesh's first face (at 0 levels: Ptex face) on its base face
    int size;   ///< corners of the base face
    int corner;
  };

  std::vector<Part> parts_;
  int levels_ = 0;
  FaceOrder order_ = FaceOrder::blender;
};

}  // namespace limitsurf
