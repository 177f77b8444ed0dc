// SPDX-License-Identifier: Apache-2.0
#include "bench/support/mesh_arrays.h"

#include "bench/support/numpy_file.h"

namespace limitsurf::bench {

MeshArrays::MeshArrays(const test::Cage& cage) : positions(cage.positions), options(cage.options) {
  for (const std::vector<int>& face : cage.faces) {
    face_sizes.push_back(static_cast<std::int64_t>(face.size()));
    face_vertices.insert(face_vertices.end(), face.begin(), face.end());
  }
}

int MeshArrays::ptexFaceCount() const {
  int count = 0;
  for (const std::int64_t size : face_sizes) count += size == 4 ? 1 : static_cast<int>(size);
  return count;
}

void MeshArrays::save(const std::string& path) const {
  writeNumpy(path + ".positions.npy", positions);
  writeNumpy(path + ".face_sizes.npy", face_sizes);
  writeNumpy(path + ".face_vertices.npy", face_vertices);
}

}  // namespace limitsurf::bench
