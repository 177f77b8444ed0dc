// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"
#include "support/cages/cage.h"

namespace limitsurf::bench {

/// A control mesh as arrays, from which each library makes its own.
struct MeshArrays {
  MeshArrays(const test::Cage& cage);

  int faceCount() const { return static_cast<int>(face_sizes.size()); }
  int ptexFaceCount() const;
  /// The diagonal of the bounding box.
  double diagonal() const { return test::diagonal(positions); }
  ControlMesh controlMesh() const {
    return ControlMesh(positions, face_sizes, face_vertices, options);
  }

  /// Writes PATH.positions.npy, PATH.face_sizes.npy and PATH.face_vertices.npy.
  void save(const std::string& path) const;

  Points positions;
  std::vector<std::int64_t> face_sizes;
  std::vector<std::int64_t> face_vertices;
  MeshOptions options;
};

}  // namespace limitsurf::bench
