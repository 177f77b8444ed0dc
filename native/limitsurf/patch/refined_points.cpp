// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/refined_points.h"

#include <algorithm>
#include <cstring>

#include "limitsurf/mesh/limits.h"
#include "limitsurf/random_bits.h"

namespace limitsurf {

int RefinedPoints::addFacePoint(Span<int> sources) {
  const int size = static_cast<int>(sources.size());
  return add(sources, known(face_masks_, size, [&](std::vector<double>& mask) {
               mask.assign(sources.size(), rules_.faceMask(size));
             }));
}

int RefinedPoints::addMidpoint(int end_0, int end_1) {
  const int sources[] = {end_0, end_1};
  return add({sources, 2}, known(midpoints_, 0, [&](std::vector<double>& mask) {
               const auto m = rules_.edgeMask(true);
               mask = {m.vertices[0], m.vertices[1]};
             }));
}

int RefinedPoints::addEdgePoint(const int (&sources)[4], int face_size_0, int face_size_1) {
  // The rules tell triangles from all other faces, and nothing else.
  const int triangles = (face_size_0 == 3 ? 1 : 0) + (face_size_1 == 3 ? 2 : 0);
  return add({sources, 4}, known(edge_masks_, triangles, [&](std::vector<double>& mask) {
               const auto m = rules_.edgeMask(false, face_size_0, face_size_1);
               mask = {m.vertices[0], m.vertices[1], m.faces[0], m.faces[1]};
             }));
}

int RefinedPoints::addEdgePoint(const int (&sources)[4], float sharpness,
                                const float child_sharpness[2], int face_size_0, int face_size_1) {
  const auto m = rules_.edgeMask(sharpness, child_sharpness, face_size_0, face_size_1);
  const double weights[] = {m.vertices[0], m.vertices[1], m.faces[0], m.faces[1]};
  return addPoint({sources, 4}, {weights, 4});
}

int RefinedPoints::addVertexPoint(Span<int> sources, VertexRule rule, int edge_count) {
  return add(sources, known(vertex_masks_[static_cast<int>(rule)], edge_count,
                            [&](std::vector<double>& mask) {
                              const auto m = rules_.vertexMask(rule, edge_count);
                              mask = {m.vertex};
                              if (rule == VertexRule::crease) {
                                mask.insert(mask.end(), {m.edges.front(), m.edges.back()});
                              } else if (rule == VertexRule::smooth) {
                                mask.insert(mask.end(), m.edges.begin(), m.edges.end());
                                mask.insert(mask.end(), m.faces.begin(), m.faces.end());
                              }
                            }));
}

int RefinedPoints::addPoint(Span<int> sources, Span<double> weights) {
  SmallArray<int> kept(sources.size());
  SmallArray<double> mask(sources.size());
  std::size_t count = 0;
  std::uint64_t key = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (weights[i] != 0) {
      kept[count] = sources[i];
      mask[count++] = weights[i];
      std::uint64_t bits;
      std::memcpy(&bits, &weights[i], sizeof bits);
      key = mixed(key + bits);
    }
  }
  const Span<double> wanted(mask.data(), count);
  recent_masks_.resize(kRecentMasks, -1);
  int& number = recent_masks_[key % kRecentMasks];
  const Span<double> known = number < 0 ? Span<double>() : this->mask(number);
  if (!std::equal(known.begin(), known.end(), wanted.begin(), wanted.end())) {
    number = addMask(wanted);
  }
  return add({kept.data(), count}, number);
}

int RefinedPoints::addReflection(int inner, int next) {
  const int sources[] = {inner, next};
  return add({sources, 2},
             known(reflections_, 0, [](std::vector<double>& mask) { mask = {2, -1}; }));
}

void RefinedPoints::shrink() {
  source_offsets_.shrink();
  sources_.shrink();
  mask_of_.shrink();
  weights_.shrink();
  masks_.shrink_to_fit();
}

int RefinedPoints::add(Span<int> sources, int mask) {
  const std::size_t first = sources_.append(sources.data(), sources.size());
  if (mask_of_.size() % kPointsPerBase == 0) {
    first_sources_.push_back(first);
  }
  source_offsets_.push_back(static_cast<std::uint32_t>(first - first_sources_.back()));
  mask_of_.push_back(mask);
  return size() - 1;
}

template <typename Make>
int RefinedPoints::known(KnownMasks& masks, int number, const Make& make) {
  if (number >= static_cast<int>(masks.size())) {
    masks.resize(static_cast<std::size_t>(number) + 1, -1);
  }
  if (masks[number] < 0) {
    std::vector<double> weights;
    make(weights);
    masks[number] = addMask(weights);
  }
  return masks[number];
}

int RefinedPoints::addMask(Span<double> weights) {
  static_assert(2 * kMaxValence + 1 <= PartArray<double>::mostTogether(), "the longest mask");
  masks_.push_back({weights_.append(weights.data(), weights.size()), weights.size()});
  return static_cast<int>(masks_.size()) - 1;
}

}  // namespace limitsurf
