// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "support/cages/cage.h"

namespace limitsurf::test {

/// Collects vertices and faces.
class CageBuilder {
 public:
  /// Returns the new vertex.
  int addVertex(const Vector3& position) {
    rows_.push_back(position);
    return static_cast<int>(rows_.size()) - 1;
  }
  void addFace(std::vector<int> vertices) { faces_.push_back(std::move(vertices)); }
  /// Adds the vertices and faces of another cage beside what there is.
  void append(const Cage& part);
  Cage build() const;

 private:
  std::vector<Vector3> rows_;
  std::vector<std::vector<int>> faces_;
};

}  // namespace limitsurf::test
