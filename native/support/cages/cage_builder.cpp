// SPDX-License-Identifier: Apache-2.0
#include "support/cages/cage_builder.h"

namespace limitsurf::test {

void CageBuilder::append(const Cage& part) {
  const int first = static_cast<int>(rows_.size());
  for (int v = 0; v < part.vertexCount(); ++v) rows_.emplace_back(part.positions.row(v));
  for (std::vector<int> face : part.faces) {
    for (int& vertex : face) vertex += first;
    faces_.push_back(std::move(face));
  }
}

Cage CageBuilder::build() const {
  Cage cage;
  cage.positions.resize(static_cast<Eigen::Index>(rows_.size()), 3);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    cage.positions.row(static_cast<Eigen::Index>(i)) = rows_[i];
  }
  cage.faces = faces_;
  return cage;
}

}  // namespace limitsurf::test
