// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/refined_points.h"

namespace limitsurf {
namespace {

// The first entry of a MaskKey.
constexpr int kReflection = 0, kFace = 1, kEdge = 2, kVertex = 3;

}  // namespace

int RefinedPoints::addFacePoint(const std::vector<int>& sources) {
  return add(sources, {kFace, static_cast<int>(sources.size()), 0});
}

int RefinedPoints::addEdgePoint(const std::vector<int>& sources, int face_size_0, int face_size_1) {
  if (sources.size() == 2) {
    return add(sources, {kEdge, 0, 0});
  }
  // Only triangles have weights of their own.
  return add(sources, {kEdge, face_size_0 == 3 ? 3 : 4, face_size_1 == 3 ? 3 : 4});
}

int RefinedPoints::addVertexPoint(const std::vector<int>& sources, VertexRule rule,
                                  int edge_count) {
  return add(sources, {kVertex + static_cast<int>(rule), edge_count, 0});
}

int RefinedPoints::addReflection(int inner, int next) {
  return add({inner, next}, {kReflection, 0, 0});
}

int RefinedPoints::add(const std::vector<int>& sources, const MaskKey& key) {
  const auto [known, is_new] = known_masks_.try_emplace(key, static_cast<int>(masks_.size()));
  if (is_new) {
    masks_.push_back(mask(key, sources.size()));
  }
  mask_of_.push_back(known->second);
  sources_.insert(sources_.end(), sources.begin(), sources.end());
  offsets_.push_back(sources_.size());
  return size() - 1;
}

std::vector<double> RefinedPoints::mask(const MaskKey& key, std::size_t source_count) const {
  const auto& [kind, a, b] = key;
  std::vector<double> weights;
  if (kind == kReflection) {
    weights = {2, -1};
  } else if (kind == kFace) {
    weights.assign(source_count, rules_.faceMask(a));
  } else if (kind == kEdge) {
    const auto m = rules_.edgeMask(source_count == 2, a, b);
    weights = {m.vertices[0], m.vertices[1]};
    if (source_count > 2) {
      weights.insert(weights.end(), {m.faces[0], m.faces[1]});
    }
  } else {
    const auto m = rules_.vertexMask(static_cast<VertexRule>(kind - kVertex), a);
    weights = {m.vertex};
    weights.insert(weights.end(), m.edges.begin(), m.edges.end());
    weights.insert(weights.end(), m.faces.begin(), m.faces.end());
  }
  return weights;
}

}  // namespace limitsurf
