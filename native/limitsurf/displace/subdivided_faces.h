// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/mesh/control_mesh.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The order in which a program that subdivides a mesh numbers the faces that it makes. Those of
/// one face always follow each other, faces in the mesh's order.
enum class FaceOrder {
  blender,     ///< of Subdivision Surface and Multiresolution: inner cells, then strips
  opensubdiv,  ///< corner by corner, and so on within each child
};

constexpr int kMostSubdivisions = 12;

/// Which face of a subdivided control mesh lies where on the mesh that it was made of.
///
/// The subdivided mesh may have any shape and number its vertices as it likes: what counts is that
/// its faces are those of the base, subdivided `levels()` times, in one of the known orders, and
/// share vertices as those do. At 0 levels the two have the same faces. All of that is checked when
/// the object is made; nothing is ever guessed from positions.
class SubdividedFaces {
 public:
  /// Throws MeshError, "structures do not match: ...", for a number of faces that no subdivision of
  /// the base has, and naming the first face that has another size, or shares its vertices with
  /// other faces, than the base's subdivision. Cost: O(faces), 16 bytes each for as long as it
  /// takes.
  SubdividedFaces(const ControlMesh& base, const ControlMesh& subdivided);

  int levels() const { return levels_; }
  /// Up to one level the orders are the same, and blender is said.
  FaceOrder order() const { return order_; }
  int baseFaceCount() const { return static_cast<int>(parts_.size()); }

  /// The same place on the subdivided mesh: exactly, for (u, v) are scaled by a power of two. Of
  /// places between faces, the face towards (1, 1) is given. `at.face` is one of the base's Ptex
  /// faces.
  Location locate(const Location& at) const;
  std::vector<Location> locate(Span<Location> at, int threads = 0) const;

 private:
  /// A Ptex face of the base.
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
