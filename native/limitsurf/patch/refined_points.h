// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/part_array.h"
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

  /// The sources of a new point, while they are gathered. Meanwhile other points may be made, of
  /// which some may become sources of this one.
  class Sources {
   public:
    explicit Sources(RefinedPoints& points) : stack_(points.gathered_), first_(stack_.size()) {}
    ~Sources() { stack_.resize(first_); }
    Sources(const Sources&) = delete;
    Sources& operator=(const Sources&) = delete;

    void push_back(int point) { stack_.push_back(point); }
    operator Span<int>() const { return Span<int>(stack_).subspan(first_, stack_.size() - first_); }

   private:
    std::vector<int>& stack_;
    std::size_t first_;
  };

  /// The new point of a face. The sources are its vertices.
  int addFacePoint(Span<int> sources);
  /// The midpoint, which is the new point of a boundary or of an infinitely sharp edge.
  int addMidpoint(int end_0, int end_1);
  /// The new point of a smooth edge. The sources are its ends and the new points of its two faces,
  /// which have the sizes given.
  int addEdgePoint(const int (&sources)[4], int face_size_0, int face_size_1);
  /// The new point of a semi-sharp edge, from the same sources.
  int addEdgePoint(const int (&sources)[4], float sharpness, const float child_sharpness[2],
                   int face_size_0, int face_size_1);
  /// The new point of a vertex. The sources are the vertex, the far ends of its edges and the new
  /// points of its faces, as far as the rule needs them: a crease takes the first and the last
  /// edge, a corner takes none.
  int addVertexPoint(Span<int> sources, VertexRule rule, int edge_count);
  /// A point with any mask. Sources whose weight is 0 are left out.
  int addPoint(Span<int> sources, Span<double> weights);

  /// 2 inner - next: the surface's linear continuation past a boundary (Lacewell &
  /// Burley 2007, figure 2).
  int addReflection(int inner, int next);

  /// Frees the room for more points.
  void shrink();

  Span<int> sources(int point) const {
    const auto i = static_cast<std::size_t>(point - cage_points_);
    const std::size_t first = first_sources_[i / kPointsPerBase] + source_offsets_[i];
    return Span<int>(&sources_[first], masks_[mask_of_[i]].size);
  }
  Span<double> weights(int point) const {
    return mask(mask_of_[static_cast<std::size_t>(point - cage_points_)]);
  }

  const SubdivisionRules<double>& rules() const { return rules_; }

 private:
  /// The mask of a rule that depends on one number, by that number; -1: not made yet.
  using KnownMasks = std::vector<int>;

  struct Mask {
    std::size_t first, size;  ///< in `weights_`
  };
  Span<double> mask(int i) const {
    return Span<double>(&weights_[masks_[i].first], masks_[i].size);
  }
  int add(Span<int> sources, int mask);
  /// The known mask to a number, or the one that make(out) writes.
  template <typename Make>
  int known(KnownMasks& masks, int number, const Make& make);
  int addMask(Span<double> weights);

  int cage_points_;
  SubdivisionRules<double> rules_;
  // So many points have their places in `sources_` relative to the first one's, which takes half
  // the memory.
  static constexpr std::size_t kPointsPerBase = 4096;
  std::vector<std::size_t> first_sources_;
  PartArray<std::uint32_t> source_offsets_;
  PartArray<int> sources_, mask_of_;
  std::vector<int> gathered_;  // by Sources

  PartArray<double> weights_;  // of all masks
  std::vector<Mask> masks_;
  KnownMasks reflections_, face_masks_, midpoints_, edge_masks_, vertex_masks_[3];
  // Some of the masks that were made lately, each at a place that follows from its weights. Most
  // masks of fractional sharpness occur once, so that it would not pay to know all.
  static constexpr std::size_t kRecentMasks = 1024;
  std::vector<int> recent_masks_;
};

}  // namespace limitsurf
