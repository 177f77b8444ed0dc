// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "limitsurf/rules/subdivision_rules.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Control points of refined levels, each a linear combination of earlier points. The cage's points
/// come first and have the numbers of its vertices; refined points follow in the order in which
/// they are made.
///
/// A point stores the numbers of its sources. Its weights (the mask) depend only on the topology
/// and the sharpness around it, and all points with equal weights share them.
class RefinedPoints {
 public:
  RefinedPoints(int cage_points, const SubdivisionOptions& options)
      : cage_points_(cage_points), rules_(options) {}

  int cagePoints() const { return cage_points_; }
  int size() const { return cage_points_ + static_cast<int>(mask_of_.size()); }

  /// The new point of a face. The sources are its vertices.
  int addFacePoint(const std::vector<int>& sources);
  /// The midpoint, which is the new point of a boundary or of an infinitely sharp edge.
  int addMidpoint(int end_0, int end_1);
  /// The new point of a smooth edge. The sources are its ends and the new points of its two faces,
  /// which have the sizes given.
  int addEdgePoint(const std::vector<int>& sources, int face_size_0, int face_size_1);
  /// The new point of a semi-sharp edge, from the same sources.
  int addEdgePoint(const std::vector<int>& sources, float sharpness, const float child_sharpness[2],
                   int face_size_0, int face_size_1);
  /// The new point of a vertex. The sources are the vertex, the far ends of its edges and the new
  /// points of its faces, as far as the rule needs them: a crease takes the first and the last
  /// edge, a corner takes none.
  int addVertexPoint(const std::vector<int>& sources, VertexRule rule, int edge_count);
  /// A point with any mask. Sources whose weight is 0 are left out.
  int addPoint(const std::vector<int>& sources, const std::vector<double>& weights);

  /// 2 inner - next: the surface's linear continuation past a boundary (Lacewell &
  /// Burley 2007, figure 2).
  int addReflection(int inner, int next);

  Span<int> sources(int point) const {
    const std::size_t i = static_cast<std::size_t>(point - cage_points_);
    return Span<int>(sources_).subspan(offsets_[i], offsets_[i + 1] - offsets_[i]);
  }
  const std::vector<double>& weights(int point) const {
    return masks_[mask_of_[static_cast<std::size_t>(point - cage_points_)]];
  }

  const SubdivisionRules<double>& rules() const { return rules_; }

 private:
  using MaskKey = std::tuple<int, int, int>;
  int add(const std::vector<int>& sources, const MaskKey& key);
  int add(const std::vector<int>& sources, int mask);
  std::vector<double> mask(const MaskKey& key, std::size_t source_count) const;

  int cage_points_;
  SubdivisionRules<double> rules_;
  std::vector<std::size_t> offsets_ = {0};
  std::vector<int> sources_;
  std::vector<int> mask_of_;
  std::vector<std::vector<double>> masks_;
  std::map<MaskKey, int> known_masks_;
  std::map<std::vector<double>, int> other_masks_;
};

}  // namespace limitsurf
