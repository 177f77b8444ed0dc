// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "limitsurf/rules/subdivision_rules.h"

namespace limitsurf {

/// The sharpness of the edges around a vertex, while it decays step by step.
class DecayingSharpness {
 public:
  DecayingSharpness(const SubdivisionOptions& options, std::vector<float> edges)
      : crease_(sdcOptions(options)), edges_(std::move(edges)) {
    step();
  }

  const std::vector<float>& edges() const { return edges_; }
  const std::vector<float>& nextEdges() const { return next_; }
  bool semiSharp() const { return anySemiSharp(edges_); }
  bool nextSemiSharp() const { return anySemiSharp(next_); }
  void advance() {
    edges_ = next_;
    step();
  }

  /// The weight of the sharp rule in a step after which the first `count` edges are smooth.
  float weight(int count) const {
    const Span<float> first(edges_.data(), static_cast<std::size_t>(count));
    const SmallArray<int> order = sharpnessOrder(first);
    const SmallArray<float> edges = inOrder(first, order);
    const SmallArray<float> next = inOrder({next_.data(), first.size()}, order);
    return std::min(
        1.f, crease_.ComputeFractionalWeightAtVertex(0, 0, count, edges.data(), next.data()));
  }

 private:
  static bool anySemiSharp(const std::vector<float>& edges) {
    return std::any_of(edges.begin(), edges.end(), isSemiSharp);
  }
  void step() { subdivideSharpness(crease_, edges_, next_); }

  OpenSubdiv::Sdc::Crease crease_;
  std::vector<float> edges_, next_;
};

}  // namespace limitsurf
