// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "limitsurf/mesh/subdivision_rules.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Control points of refined levels, each a combination of earlier points. The cage's points come
/// first and are numbered as its vertices; refined points follow in the order of their making.
///
/// A point stores the numbers of its sources; the weights (the mask) depend on its neighbourhood's
/// topology alone and are shared by all points that have the same.
class RefinedPoints {
 public:
  RefinedPoints(int cage_points, Triangles triangles)
      : cage_points_(cage_points), rules_(triangles) {}

  int cagePoints() const { return cage_points_; }
  int size() const { return cage_points_ + static_cast<int>(mask_of_.size()); }

  /// The new point of a face. Sources: its vertices.
  int addFacePoint(const std::vector<int>& sources);
  /// Sources: the edge's ends and the points of its two faces (of the sizes given) or, on a
  /// boundary, the ends alone.
  int addEdgePoint(const std::vector<int>& sources, int face_size_0, int face_size_1);
  /// Sources: the vertex, the far ends of its edges and (smooth rule) the points of its faces.
  int addVertexPoint(const std::vector<int>& sources, VertexRule rule, int edge_count);

  /// 2 inner - next: the surface's linear continuation past a boundary (paper, figure 2).
  int addReflection(int inner, int next);

  Span<int> sources(int point) const {
    const std::size_t i = static_cast<std::size_t>(point - cage_points_);
    return Span<int>(sources_).subspan(offsets_[i], offsets_[i + 1] - offsets_[i]);
  }
  const std::vector<double>& weights(int point) const {
    return masks_[mask_of_[static_cast<std::size_t>(point - cage_points_)]];
  }

 private:
  using MaskKey = std::tuple<int, int, int>;
  int add(const std::vector<int>& sources, const MaskKey& key);
  std::vector<double> mask(const MaskKey& key, std::size_t source_count) const;

  int cage_points_;
  SubdivisionRules<double> rules_;
  std::vector<std::size_t> offsets_ = {0};
  std::vector<int> sources_;
  std::vector<int> mask_of_;
  std::vector<std::vector<double>> masks_;
  std::map<MaskKey, int> known_masks_;
};

}  // namespace limitsurf
