// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/refined_points.h"

namespace limitsurf {
namespace {

// The first entry of a MaskKey.
constexpr int kReflection = 0, kFace = 1, kMidpoint = 2, kEdge = 3, kVertex = 4;

}  // namespace

int RefinedPoints::addFacePoint(const std::vector<int>& sources) {
  return add(sources, MaskKey{kFace, static_cast<int>(sources.size()), 0});
}

int RefinedPoints::addMidpoint(int end_0, int end_1) {
  return add({end_0, end_1}, MaskKey{kMidpoint, 0, 0});
}

int RefinedPoints::addEdgePoint(const std::vector<int>& sources, int face_size_0, int face_size_1) {
  // The rules tell triangles from all other faces, and nothing else.
  return add(sources, MaskKey{kEdge, face_size_0 == 3 ? 3 : 4, face_size_1 == 3 ? 3 : 4});
}

int RefinedPoints::addEdgePoint(const std::vector<int>& sources, float sharpness,
                                const float child_sharpness[2], int face_size_0, int face_size_1) {
  const auto m = rules_.edgeMask(sharpness, child_sharpness, face_size_0, face_size_1);
  return addPoint(sources, {m.vertices[0], m.vertices[1], m.faces[0], m.faces[1]});
}

int RefinedPoints::addVertexPoint(const std::vector<int>& sources, VertexRule rule,
                                  int edge_count) {
  return add(sources, MaskKey{kVertex + static_cast<int>(rule), edge_count, 0});
}

int RefinedPoints::addPoint(const std::vector<int>& sources, const std::vector<double>& weights) {
  std::vector<int> kept;
  std::vector<double> mask;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (weights[i] != 0) {
      kept.push_back(sources[i]);
      mask.push_back(weights[i]);
    }
  }
  const auto [known, is_new] = other_masks_.try_emplace(mask, static_cast<int>(masks_.size()));
  if (is_new) {
    masks_.push_back(std::move(mask));
  }
  return add(kept, known->second);
}

int RefinedPoints::addReflection(int inner, int next) {
  return add({inner, next}, MaskKey{kReflection, 0, 0});
}

int RefinedPoints::add(const std::vector<int>& sources, const MaskKey& key) {
  const auto [known, is_new] = known_masks_.try_emplace(key, static_cast<int>(masks_.size()));
  if (is_new) {
    masks_.push_back(mask(key, sources.size()));
  }
  return add(sources, known->second);
}

int RefinedPoints::add(const std::vector<int>& sources, int mask) {
  mask_of_.push_back(mask);
  sources_.insert(sources_.end(), sources.begin(), sources.end());
  offsets_.push_back(sources_.size());
  return size() - 1;
}

std::vector<double> RefinedPoints::mask(const MaskKey& key, std::size_t source_count) const {
  const auto& [kind, a, b] = key;
  if (kind == kReflection) {
    return {2, -1};
  }
  if (kind == kFace) {
    return std::vector<double>(source_count, rules_.faceMask(a));
  }
  if (kind == kMidpoint || kind == kEdge) {
    const auto m = rules_.edgeMask(kind == kMidpoint, a, b);
    std::vector<double> weights = {m.vertices[0], m.vertices[1]};
    if (kind == kEdge) {
      weights.insert(weights.end(), {m.faces[0], m.faces[1]});
    }
    return weights;
  }
  const VertexRule rule = static_cast<VertexRule>(kind - kVertex);
  const auto m = rules_.vertexMask(rule, a);
  std::vector<double> weights = {m.vertex};
  if (rule == VertexRule::crease) {
    weights.insert(weights.end(), {m.edges.front(), m.edges.back()});
  } else if (rule == VertexRule::smooth) {
    weights.insert(weights.end(), m.edges.begin(), m.edges.end());
    weights.insert(weights.end(), m.faces.begin(), m.faces.end());
  }
  return weights;
}

}  // namespace limitsurf
